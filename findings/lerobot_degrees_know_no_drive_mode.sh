#!/usr/bin/env bash
# lerobot 0.6.1: drive_mode turns a Feetech joint round in per cent, and does nothing in degrees.
#
# A calibration says drive_mode: 1 for a joint that turns against its servo, and MotorsBus negates its
# values. A good guess is that this holds for each of the units it offers. It does for RANGE_M100_100
# and RANGE_0_100; DEGREES, which SO-100 and SO-101 followers use unless use_degrees is false, leaves
# drive_mode out. So the same calibration file and the same position of the servo are -20 % with one
# setting and +17.6 degrees with the other: a goal in degrees moves an inverted joint the wrong way. The
# two methods are taken out of the wheel, as the package needs Python 3.12; nothing is changed in them.
set -euo pipefail

folder=$(mktemp -d)
trap 'rm -rf "$folder"' EXIT
python3 -m venv "$folder/venv"
"$folder/venv/bin/pip" download -q --no-deps --only-binary=:all: --python-version 3.12 \
  -d "$folder" 'lerobot==0.6.1'

"$folder/venv/bin/python" - "$folder"/lerobot-*.whl <<'PYTHON'
import re
import sys
import textwrap
import zipfile
from enum import Enum
from pathlib import Path
from types import SimpleNamespace

wheel = Path(sys.argv[1])
with zipfile.ZipFile(wheel) as archive:
    source = archive.read("lerobot/motors/motors_bus.py").decode()
    feetech = archive.read("lerobot/motors/feetech/feetech.py").decode()
names = {"Enum": Enum}
for pattern in (
    r"^class MotorNormMode.*?(?=^@)",
    r"^    def _normalize\(.*?(?=^    def )",
    r"^    def _unnormalize\(.*?(?=^    @)",
):
    part = re.search(pattern, source, re.MULTILINE | re.DOTALL).group()
    exec("from __future__ import annotations\n" + textwrap.dedent(part), names)
assert "apply_drive_mode = True" in feetech
Mode = names["MotorNormMode"]


def bus(mode: Mode, drive_mode: int) -> SimpleNamespace:
    """Return what the two methods need of a bus with one STS3215."""
    calibration = SimpleNamespace(range_min=1047, range_max=3047, drive_mode=drive_mode)
    return SimpleNamespace(
        calibration={"joint": calibration},
        motors={"joint": SimpleNamespace(norm_mode=mode)},
        apply_drive_mode=True,
        model_resolution_table={"sts3215": 4096},
        _id_to_name=lambda number: "joint",
        _id_to_model=lambda number: "sts3215",
    )


print(wheel.name.split("-py3")[0])
signs = {}
for mode in (Mode.RANGE_M100_100, Mode.RANGE_0_100, Mode.DEGREES):
    read, sent = [], []
    for drive_mode in (0, 1):
        one = bus(mode, drive_mode)
        read.append(names["_normalize"](one, {1: 2247})[1])
        sent.append(names["_unnormalize"](one, {1: 60.0})[1])
    print(
        f"{mode.value}: step 2247 is {read[0]:.2f}, with drive_mode 1 {read[1]:.2f}; "
        f"the goal 60 is step {sent[0]}, with drive_mode 1 {sent[1]}"
    )
    signs[mode.value] = (read[0] == read[1], sent[0] == sent[1])
expected = {"range_m100_100": (False, False), "range_0_100": (False, False), "degrees": (True, True)}
if signs != expected:
    sys.exit("the behaviour has changed")
PYTHON
# Output seen:
# lerobot-0.6.1
# range_m100_100: step 2247 is 20.00, with drive_mode 1 -20.00; the goal 60 is step 2647, with drive_mode 1 1447
# range_0_100: step 2247 is 60.00, with drive_mode 1 40.00; the goal 60 is step 2247, with drive_mode 1 1847
# degrees: step 2247 is 17.58, with drive_mode 1 17.58; the goal 60 is step 2729, with drive_mode 1 2729
