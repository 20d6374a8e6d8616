"""Read a file that lists the robots of one world, each with its own namespace."""

import math
import os
import re
import shlex
from collections.abc import Callable, Mapping
from dataclasses import dataclass, fields
from pathlib import Path
from typing import Any

from arm_gazebo.errors import SimSettingsError
from arm_gazebo.launching.robot_setup import SPAWN_AUTO
from arm_gazebo.launching.settings_file import parse_yaml, read_text
from arm_node.names import listing

TITLE = "the robots' file"
NAMESPACE = re.compile(r"[A-Za-z]\w*", re.ASCII)
LIST_JOINERS: Mapping[str, Callable[[list[str]], str]] = {
    "model_args": shlex.join,
    "spawn": ",".join,
    "package_path": os.pathsep.join,
}
"""The keys that may be lists, and how to join them for sim.launch.py's argument of that name."""


@dataclass(frozen=True, slots=True)
class RobotRequest:
    """One robot of the file; the attributes are named like sim.launch.py's arguments.

    Attributes:
        model: URDF or xacro file.
        model_args: xacro arguments, "a:=1 b:=2".
        controllers: parameter file, "" for the default controllers.
        spawn: controllers to start.
        package_path: folders, separated by colons.
        base: "fixed" or "free".
        pose: x y z roll pitch yaw of the root in the world, in m and rad; () for the default.
    """

    model: str
    model_args: str = ""
    controllers: str = ""
    spawn: str = SPAWN_AUTO
    package_path: str = ""
    base: str = "fixed"
    pose: tuple[float, ...] = ()


def read_robots_file(path: Path | str) -> dict[str, RobotRequest]:
    """Return the robots by namespace; relative paths start in the file's folder.

    Raises:
        SimSettingsError: the file cannot be read, or has an invalid entry.
    """
    file = Path(path).expanduser().absolute()
    content = parse_yaml(read_text(file, TITLE), file, TITLE)
    if not isinstance(content, Mapping) or not content:
        raise SimSettingsError(f"{TITLE} {file} names no robots; it needs NAMESPACE: model:")
    return {str(name): _request(file, str(name), entry) for name, entry in content.items()}


def _request(file: Path, name: str, entry: object) -> RobotRequest:
    where = f"{TITLE} {file}, '{name}'"
    if not NAMESPACE.fullmatch(name):
        raise SimSettingsError(
            f"{where}: this is not a namespace; it takes letters, digits and underscores"
        )
    if not isinstance(entry, Mapping) or not entry.get("model"):
        raise SimSettingsError(f"{where} has no model: FILE")
    known = [field.name for field in fields(RobotRequest)]
    unknown = [str(key) for key in entry if key not in known]
    if unknown:
        raise SimSettingsError(f"{where} has the key '{unknown[0]}'; it takes {listing(known)}")
    # A key without a value counts as missing.
    filled = {key: value for key, value in entry.items() if value is not None}
    pose = _pose(where, filled.pop("pose", []))
    texts = {key: _text(where, key, value) for key, value in filled.items()}
    for key in ("model", "controllers"):
        if texts.get(key) and "://" not in texts[key]:
            texts[key] = str(file.parent / Path(texts[key]).expanduser())
    return RobotRequest(**texts, pose=pose)


def _text(where: str, key: str, value: Any) -> str:
    if isinstance(value, list) and key in LIST_JOINERS:
        return LIST_JOINERS[key]([str(word) for word in value])
    if isinstance(value, (list, Mapping)):
        raise SimSettingsError(f"{where}: {key} takes a text, not {value!r}")
    return str(value)


def _pose(where: str, value: Any) -> tuple[float, ...]:
    try:
        pose = tuple(map(float, value if isinstance(value, list) else [value]))
    except (OverflowError, TypeError, ValueError):
        pose = (math.nan,)
    if len(pose) not in (0, 6) or not all(map(math.isfinite, pose)):
        raise SimSettingsError(f"{where}: pose takes x y z roll pitch yaw, not {value!r}")
    return pose
