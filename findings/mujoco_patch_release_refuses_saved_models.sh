#!/usr/bin/env bash
# mujoco-core 4.0.1: a model that 4.0.0 has saved as .mjb is refused, though the two files differ in one byte.
#
# A good guess, for a patch release of the same format, is that saved models can still be read, or that the
# error says what is wrong. mj_saveModel() writes the whole version, patch level included, into the file's
# head, and every other number is refused: ValueError "mj_loadModel: failed to load from mjb", and a warning
# that the versions differ, without saying which they are. Whatever keeps compiled models, such as a cache,
# a recording or a data set, is lost by an upgrade with pip. Of one model, 4.0.0 and 4.0.1 write the same
# bytes but for that number, and with the number changed 4.0.1 reads the file and simulates the same bits.
# Keep the XML beside an .mjb.
set -euo pipefail

folder=$(mktemp -d)
trap 'rm -rf "$folder"' EXIT
cat > "$folder/model.py" <<'PYTHON'
import struct
import sys
from pathlib import Path

import mujoco
import numpy as np

PENDULUM = """<mujoco><worldbody><body><joint name="hinge" axis="0 1 0"/>
<geom type="capsule" size="0.02 0.2" pos="0.2 0 0" euler="0 90 0" mass="1"/></body></worldbody></mujoco>"""
folder, other = Path(sys.argv[1]), sys.argv[2:]


def angle_after_a_second(model: mujoco.MjModel) -> float:
    """Return the joint's position in rad."""
    data = mujoco.MjData(model)
    mujoco.mj_step(model, data, 500)
    return float(data.qpos[0])


def read(content: bytes) -> mujoco.MjModel:
    """Return a saved model."""
    return mujoco.MjModel.from_binary_path("a.mjb", {"a.mjb": content})


print("mujoco-core", mujoco.__version__)
compiled = mujoco.MjModel.from_xml_string(PENDULUM)
saved = np.empty(mujoco.mj_sizeModel(compiled), np.uint8)
mujoco.mj_saveModel(compiled, None, saved)
(folder / f"{mujoco.__version__}.mjb").write_bytes(saved)
if other:
    theirs = (folder / f"{other[0]}.mjb").read_bytes()
    try:
        read(theirs)
    except ValueError as error:
        refusal = str(error)
    else:
        sys.exit("the behaviour has changed")
    print(f"{other[0]}'s file:", refusal)
    differ = [i for i, pair in enumerate(zip(theirs, saved.tobytes(), strict=True)) if pair[0] != pair[1]]
    versions = *struct.unpack_from("=i", theirs, 12), mujoco.mj_version()
    print(f"bytes that differ, of {len(theirs)}:", differ, "versions", *versions)
    changed = theirs[:12] + struct.pack("=i", mujoco.mj_version()) + theirs[16:]
    angles = angle_after_a_second(read(changed)), angle_after_a_second(compiled)
    print("with the number changed, angle after a second:", *angles)
    if differ != [12] or angles[0] != angles[1]:
        sys.exit("the behaviour has changed")
PYTHON
for version in 4.0.0 4.0.1; do
  python3 -m venv "$folder/$version"
  "$folder/$version/bin/pip" install -q "mujoco-core==$version" 'numpy==2.4.6'
done
cd "$folder"  # MuJoCo writes its warning to a file in the present folder, too.
4.0.0/bin/python model.py "$folder"
4.0.1/bin/python model.py "$folder" 4.0.0
# Output seen:
# mujoco-core 4.0.0
# mujoco-core 4.0.1
# WARNING: Model and executable use different MuJoCo version
# 4.0.0's file: mj_loadModel: failed to load from mjb
# bytes that differ, of 3340: [12] versions 4000000 4000001
# with the number changed, angle after a second: 1.0189927486700943 1.0189927486700943
