#!/usr/bin/env bash
# gymnasium 1.4.0: the order of a flattened Dict depends on how the space was written down.
#
# A dict keeps its order in Python, and a good guess is that Dict({"position": ..., "gripper": ...}) flattens
# to positions and then the gripper, like Dict(position=..., gripper=...). A plain dict is sorted by
# its keys, so that the gripper comes first; keyword arguments and an OrderedDict are not. The three
# spaces are equal for ==, each takes the samples of the others, and FlattenObservation gives vectors of
# one length. A policy that was trained on one and runs on another, or after a rewrite to keywords,
# reads the gripper as a joint. The order of the observation's own dict does not count.
set -euo pipefail

folder=$(mktemp -d)
trap 'rm -rf "$folder"' EXIT
python3 -m venv "$folder/venv"
"$folder/venv/bin/pip" install -q 'gymnasium==1.4.0' 'numpy==2.4.6'

"$folder/venv/bin/python" -W error - <<'PYTHON'
import sys
from collections import OrderedDict
from importlib.metadata import version

import numpy as np
from gymnasium.spaces import Box, Dict, flatten

POSITION, GRIPPER = Box(0, 1, (2,), np.float64), Box(2, 3, (1,), np.float64)
SPACES = {
    "a dict": Dict({"position": POSITION, "gripper": GRIPPER}),
    "keywords": Dict(position=POSITION, gripper=GRIPPER),
    "an OrderedDict": Dict(OrderedDict(position=POSITION, gripper=GRIPPER)),
}
OBSERVED = {"position": np.array([0.1, 0.2]), "gripper": np.array([2.5])}

print("gymnasium", version("gymnasium"))
found = {}
for name, space in SPACES.items():
    found[name] = flatten(space, OBSERVED).tolist()
    equal = all(space == other for other in SPACES.values())
    print(f"{name}: {found[name]}; equal to the others: {equal}, takes the observation: {space.contains(OBSERVED)}")
    turned_round = flatten(space, dict(reversed(OBSERVED.items()))).tolist()
    if not equal or not space.contains(OBSERVED) or turned_round != found[name]:
        sys.exit("the behaviour has changed")
order = [0.1, 0.2, 2.5]
if found != {"a dict": [2.5, 0.1, 0.2], "keywords": order, "an OrderedDict": order}:
    sys.exit("the behaviour has changed")
PYTHON
# Output seen:
# gymnasium 1.4.0
# a dict: [2.5, 0.1, 0.2]; equal to the others: True, takes the observation: True
# keywords: [0.1, 0.2, 2.5]; equal to the others: True, takes the observation: True
# an OrderedDict: [0.1, 0.2, 2.5]; equal to the others: True, takes the observation: True
