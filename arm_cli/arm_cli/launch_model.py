"""`arm launch my_robot.urdf`: a robot or a world is launched as if its launch file were named."""

import re
from collections.abc import Sequence
from pathlib import Path

ROBOT_LAUNCH = ("arm_gazebo", "sim.launch.py")
ARGUMENTS = {".urdf": "model", ".xacro": "model", ".sdf": "world", ".world": "world"}
"""The launch argument that takes a file of this ending."""
ROOTS = {"robot": "model", "mujoco": "world", "sdf": "world"}
"""The launch argument that takes an XML file with this root."""
ROOT = re.compile(rb"<([A-Za-z_]\w*)")
LONGEST_HEAD = 10_000
"""In which part of an XML file its root stands, after comments."""


def name_launch_file(words: Sequence[str]) -> list[str]:
    """Return a launch's words with a robot or world file among them as an argument.

    A robot is launched by `sim.launch.py`, a world with the default arm.
    """
    named: list[str] = []
    for word in words:
        argument = "" if word.startswith("-") or ":=" in word else _argument(Path(word))
        if argument == "model":
            named += ROBOT_LAUNCH
        named.append(f"{argument}:={word}" if argument else word)
    return named


def _argument(path: Path) -> str:
    """Return the launch argument that takes a file, "" if none does."""
    if path.suffix != ".xml" or not path.is_file():
        return ARGUMENTS.get(path.suffix, "")
    try:
        with path.open("rb") as file:
            head = file.read(LONGEST_HEAD)
    except OSError:
        return ""  # The launcher reports it.
    root = ROOT.search(re.sub(rb"<!--.*?-->", b"", head, flags=re.DOTALL))
    return ROOTS.get(root[1].decode(), "") if root else ""
