#!/usr/bin/env bash
# casadi 3.8.2: interpolant(..., "bspline", ...) is 0 beyond its table; "linear" of the same table goes on.
#
# A table of a motor's torque, a spring or a path is often read a hair beyond its end, by a solver's trial step
# or a rounding error. A good guess is that both kinds extrapolate, or that both hold the last value. "linear"
# goes on along its last piece. "bspline" of the same points falls from 16 to 0 within a thousandth, and
# its derivative there is 0 as well, so that a solver that stepped out sees a flat plain and cannot come back.
# There is no error or warning. The ends themselves are right. Limit the argument, or add points beyond the range.
set -euo pipefail

folder=$(mktemp -d)
trap 'rm -rf "$folder"' EXIT
python3 -m venv "$folder/venv"
"$folder/venv/bin/pip" install -q 'casadi==3.8.2' 'numpy==2.4.6'

"$folder/venv/bin/python" - <<'PYTHON'
import sys

import casadi
import numpy as np

PLACES = (-0.001, 0.0, 3.999, 4.0, 4.001, 5.0)
grid = [0.0, 1.0, 2.0, 3.0, 4.0]
squares = [place * place for place in grid]

print("casadi", casadi.__version__)
found = {}
for kind in ("linear", "bspline"):
    table = casadi.interpolant("table", kind, [grid], squares)
    x = casadi.MX.sym("x")
    slope = casadi.Function("slope", [x], [casadi.jacobian(table(x), x)])
    found[kind] = [(float(table(place)), float(slope(place))) for place in PLACES]
    print(f"{kind}:", ", ".join(f"f({place}) = {found[kind][i][0]:.3f}" for i, place in enumerate(PLACES)))
    print("   slopes:", ", ".join(f"{pair[1]:.2f}" for pair in found[kind]))

values = {kind: [pair[0] for pair in pairs] for kind, pairs in found.items()}
if not (
    np.allclose(values["linear"], [-0.001, 0, 15.993, 16, 16.007, 23])
    and np.allclose(values["bspline"], [0, 0, 3.999**2, 16, 0, 0], atol=1e-6)
    and np.allclose([found["bspline"][i] for i in (0, 4, 5)], 0, atol=1e-9)
):
    sys.exit("the behaviour has changed")
PYTHON
# Output seen:
# casadi 3.8.2
# linear: f(-0.001) = -0.001, f(0.0) = 0.000, f(3.999) = 15.993, f(4.0) = 16.000, f(4.001) = 16.007, f(5.0) = 23.000
#    slopes: 1.00, 1.00, 7.00, 7.00, 7.00, 7.00
# bspline: f(-0.001) = 0.000, f(0.0) = -0.000, f(3.999) = 15.992, f(4.0) = 16.000, f(4.001) = 0.000, f(5.0) = 0.000
#    slopes: 0.00, -0.00, 8.00, 8.00, 0.00, 0.00
