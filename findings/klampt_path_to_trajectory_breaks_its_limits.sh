#!/usr/bin/env bash
# Klampt 0.10.1.post1: path_to_trajectory(path, vmax, amax) moves faster than vmax; unsmoothed, ten times slower.
#
# The standard, timing="limited", is "to respect velocity / acceleration limits". A good guess is a
# trajectory that keeps them, perhaps not the fastest one. With vmax = 1 and amax = 1 the path (0, 0),
# (1, 0), (1, 1) is run at up to 1.88 rad/s, and the speed jumps by 0.27 rad/s from one millisecond to
# the next; velocities="trapezoidal" and "minimum-jerk" reach 1.75 and 1.61 and jump by more. With
# smoothing=None it is a tenth of vmax: 20 s for what takes 4 s with a stop at the corner. No warning
# comes. makeMinTimeSpline() of HermiteTrajectory keeps both limits.
set -euo pipefail

folder=$(mktemp -d)
trap 'rm -rf "$folder"' EXIT
python3 -m venv "$folder/venv"
"$folder/venv/bin/pip" install -q 'klampt==0.10.1.post1' 'numpy==2.4.6'

"$folder/venv/bin/python" -W ignore - <<'PYTHON' | grep 'Klampt\|rad/s\|changed'
import sys
from importlib.metadata import version

import numpy as np
from klampt.model.trajectory import HermiteTrajectory, path_to_trajectory

PATH = [[0.0, 0.0], [1.0, 0.0], [1.0, 1.0]]
LIMITS = {"vmax": [1.0, 1.0], "amax": [1.0, 1.0]}


def measured(trajectory: object) -> tuple[float, float, float]:
    """Return how long it takes in s, its greatest speed in rad/s and its greatest step of speed in 1 ms."""
    times = np.arange(trajectory.times[0], trajectory.times[-1], 0.001)
    positions = np.array([trajectory.eval(time) for time in times])[:, :2]
    speeds = np.diff(positions, axis=0) / 0.001
    return times[-1], float(np.abs(speeds).max()), float(np.abs(np.diff(speeds, axis=0)).max())


print("Klampt", version("klampt"))
found = {}
for name in ("auto", "trapezoidal", "minimum-jerk"):
    found[name] = measured(path_to_trajectory(PATH, velocities=name, **LIMITS))
found["smoothing=None"] = measured(path_to_trajectory(PATH, smoothing=None, **LIMITS))
spline = HermiteTrajectory()
spline.makeMinTimeSpline(PATH, **LIMITS)
found["makeMinTimeSpline"] = measured(spline)
for name, (duration, speed, step) in found.items():
    print(f"{name}: {duration:.1f} s, at most {speed:.2f} rad/s, steps of up to {step:.2f} rad/s in 1 ms")
fast = [found[name][1] for name in ("auto", "trapezoidal", "minimum-jerk")]
if min(fast) < 1.4 or found["makeMinTimeSpline"][1] > 1.01 or not 19 < found["smoothing=None"][0] < 21:
    sys.exit("the behaviour has changed")
PYTHON
# Output seen:
# Klampt 0.10.1.post1
# auto: 4.0 s, at most 1.88 rad/s, steps of up to 0.27 rad/s in 1 ms
# trapezoidal: 5.6 s, at most 1.75 rad/s, steps of up to 0.87 rad/s in 1 ms
# minimum-jerk: 5.3 s, at most 1.61 rad/s, steps of up to 1.25 rad/s in 1 ms
# smoothing=None: 20.0 s, at most 0.10 rad/s, steps of up to 0.10 rad/s in 1 ms
# makeMinTimeSpline: 4.0 s, at most 1.00 rad/s, steps of up to 0.00 rad/s in 1 ms
