#!/usr/bin/env bash
# simple-pid 2.0.1: in a loop at 1 kHz that passes its time step, the output never changes again.
#
# A simulation passes its step: pid(measured, dt=0.001). sample_time is 0.01 unless it is set, "seconds
# which the controller should wait before generating a new output value", and a good guess is that a new
# output comes with every tenth call, or that dt stands in for it. Each call's own dt is compared with
# sample_time and no sum is kept: 0.001 is always less, so that every call returns the output of the first
# one. A joint that should go to 1 is pushed with the full first output for ever. Without dt, where the
# clock is read, time does add up, and a new output comes every 0.01 s. sample_time=None makes each call
# count.
set -euo pipefail

folder=$(mktemp -d)
trap 'rm -rf "$folder"' EXIT
python3 -m venv "$folder/venv"
"$folder/venv/bin/pip" install -q 'simple-pid==2.0.1'

"$folder/venv/bin/python" - <<'PYTHON'
import sys
from importlib.metadata import version

from simple_pid import PID

STEP_S = 0.001


def reached(seconds: float, passes_dt: bool, **settings: float | None) -> tuple[float, int]:
    """Return where a joint of speed `output` is, which should go to 1, and how many outputs there were."""
    now = 0.0
    pid = PID(5.0, 0.0, 0.0, setpoint=1.0, **settings)
    pid.time_fn = lambda: now
    pid.reset()
    position, outputs = 0.0, []
    for _ in range(round(seconds / STEP_S)):
        now += STEP_S
        outputs.append(pid(position, dt=STEP_S) if passes_dt else pid(position))
        position += outputs[-1] * STEP_S
    return position, len(set(outputs))


print("simple-pid", version("simple-pid"))
fixed = reached(3.0, True)
clock = reached(3.0, False)
each = reached(3.0, True, sample_time=None)
for name, (position, count) in {"dt": fixed, "clock": clock, "dt, sample_time=None": each}.items():
    print(f"{name}: at {position:.3f} after 3 s, {count} different outputs in 3000 calls")
if not (abs(fixed[0] - 15) < 1e-6 and fixed[1] == 1 and abs(clock[0] - 1) < 1e-3 and clock[1] > 200):
    sys.exit("the behaviour has changed")
if abs(each[0] - 1) > 1e-3 or each[1] < 2000:
    sys.exit("the behaviour has changed")
PYTHON
# Output seen:
# simple-pid 2.0.1
# dt: at 15.000 after 3 s, 1 different outputs in 3000 calls
# clock: at 1.000 after 3 s, 282 different outputs in 3000 calls
# dt, sample_time=None: at 1.000 after 3 s, 3000 different outputs in 3000 calls
