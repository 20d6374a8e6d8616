#!/usr/bin/env bash
# drake 1.51.1: after its end a trajectory stands still by value() and moves on by EvalDerivative().
#
# value(t) holds the last position for every t behind the end (and the first before the start). A good guess is
# that the derivative there is 0, or that a controller which asks for both at the same time gets two numbers that
# belong together. EvalDerivative() and MakeDerivative() hold the last velocity: a path that does not end
# at rest (waypoints joined by lines, a B-spline, a Bezier curve) goes on at full speed in the feed-forward while
# its position does not change. PiecewisePose.GetVelocity() is 0 there, but angular_velocity() of a
# PiecewiseQuaternionSlerp, of which it is made, is not. TrajectorySource, the block for diagrams, has 0: a
# loop that was tested in a diagram and written out by hand does something else at the end of each motion.
set -euo pipefail

folder=$(mktemp -d)
trap 'rm -rf "$folder"' EXIT
python3 -m venv "$folder/venv"
"$folder/venv/bin/pip" install -q 'drake==1.51.1' 'numpy==2.4.6'

"$folder/venv/bin/python" - <<'PYTHON'
import sys
from importlib.metadata import version

import numpy as np
from pydrake.math import BsplineBasis, KnotVectorType, RigidTransform, RotationMatrix
from pydrake.systems.primitives import TrajectorySource
from pydrake.trajectories import (
    BezierCurve,
    BsplineTrajectory,
    CompositeTrajectory,
    PathParameterizedTrajectory,
    PiecewisePolynomial,
    PiecewisePose,
    PiecewiseQuaternionSlerp,
)

# Each goes from 0 at 0 s to 2 at 1 s.
lines = PiecewisePolynomial.FirstOrderHold([0.0, 0.5, 1.0], np.array([[0.0, 1.0, 2.0]]))
basis = BsplineBasis(3, 3, KnotVectorType.kClampedUniform, 0.0, 1.0)
PATHS = {
    "PiecewisePolynomial": lines,
    "BsplineTrajectory": BsplineTrajectory(basis, [np.array([[value]]) for value in (0.0, 1.0, 2.0)]),
    "BezierCurve": BezierCurve(0.0, 1.0, np.array([[0.0, 1.0, 2.0]])),
    "CompositeTrajectory": CompositeTrajectory([lines]),
    "PathParameterizedTrajectory": PathParameterizedTrajectory(
        lines, PiecewisePolynomial.FirstOrderHold([0.0, 1.0], np.array([[0.0, 1.0]]))
    ),
}

print("drake", version("drake"))
found = []
for name, path in PATHS.items():
    found.append([float(get(5.0)[0, 0]) for get in (path.value, path.EvalDerivative, path.MakeDerivative().value)])
    value, slope, made = found[-1]
    print(f"{name} at 5 s: value {value:.1f}, EvalDerivative {slope:.1f}, MakeDerivative {made:.1f}")
source = TrajectorySource(lines, output_derivative_order=1)
context = source.CreateDefaultContext()
context.SetTime(5.0)
outputs = source.get_output_port().Eval(context)
print(f"TrajectorySource at 5 s: value {outputs[0]:.1f}, derivative {outputs[1]:.1f}")

turned = RotationMatrix.MakeZRotation(1.0)
pose = PiecewisePose.MakeLinear([0.0, 1.0], [RigidTransform(), RigidTransform(turned, [2.0, 0.0, 0.0])])
turn = PiecewiseQuaternionSlerp([0.0, 1.0], [RotationMatrix(), turned])
speeds = [float(np.linalg.norm(pose.GetVelocity(5.0))), float(turn.angular_velocity(5.0)[2])]
print(f"PiecewisePose at 5 s: {speeds[0]:.1f}; PiecewiseQuaternionSlerp: {speeds[1]:.1f} rad/s")
if not (np.allclose(found, 2.0) and np.allclose(outputs, [2, 0]) and np.allclose(speeds, [0, 1])):
    sys.exit("the behaviour has changed")
PYTHON
# Output seen:
# drake 1.51.1
# PiecewisePolynomial at 5 s: value 2.0, EvalDerivative 2.0, MakeDerivative 2.0
# BsplineTrajectory at 5 s: value 2.0, EvalDerivative 2.0, MakeDerivative 2.0
# BezierCurve at 5 s: value 2.0, EvalDerivative 2.0, MakeDerivative 2.0
# CompositeTrajectory at 5 s: value 2.0, EvalDerivative 2.0, MakeDerivative 2.0
# PathParameterizedTrajectory at 5 s: value 2.0, EvalDerivative 2.0, MakeDerivative 2.0
# TrajectorySource at 5 s: value 2.0, derivative 0.0
# PiecewisePose at 5 s: 0.0; PiecewiseQuaternionSlerp: 1.0 rad/s
