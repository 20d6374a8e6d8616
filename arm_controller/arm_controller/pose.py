"""A pose of the robot's joints: from numbers or a file, and within the limits of the robot."""

import math
import xml.etree.ElementTree as ElementTree
from collections.abc import Mapping, Sequence
from pathlib import Path

import yaml

Pose = tuple[float, ...]
"""Positions (rad or m), one per joint, in the order of the joints."""
Limits = Mapping[str, tuple[float, float]]
"""The range (rad or m) of each joint that has limits, by its name."""


class ArmControllerError(Exception):
    """Root of this package's errors; every message is a sentence for the user."""


class PoseError(ArmControllerError):
    """A pose has the wrong length, is not finite, or exceeds a joint's limits."""


class PoseFileError(ArmControllerError):
    """A file of poses is missing, unreadable or invalid; the message names file and line."""


def read_pose(values: Sequence[float], joints: Sequence[str]) -> Pose:
    """Return numbers as a pose.

    Raises:
        PoseError: there is not one finite number per joint.
    """
    if len(values) != len(joints):
        raise PoseError(
            f"a pose is {len(joints)} numbers, one for each of the joints "
            f"{', '.join(joints)}; {len(values)} were given"
        )
    for name, value in zip(joints, values, strict=True):
        if not math.isfinite(value):
            raise PoseError(f"joint '{name}' cannot go to {value}: not a finite number")
    return tuple(values)


def shown(pose: Pose) -> str:
    """Return a pose as the nodes print it."""
    return "[" + ", ".join(f"{position:.6f}" for position in pose) + "]"


def read_limits(description: str, joints: Sequence[str]) -> Limits:
    """Return the limits that a URDF gives to these joints.

    Raises:
        PoseError: it is not a URDF, or has no such joint; the message names those that it has.
    """
    try:
        # Only the robot's own: <ros2_control> and <transmission> name joints as well.
        joint_elements = ElementTree.fromstring(description).findall("joint")
        found = {joint.get("name", ""): joint for joint in joint_elements}
        movable = {name: j for name, j in found.items() if j.get("type", "fixed") != "fixed"}
        bounds = {
            name: (float(limit.get("lower", 0.0)), float(limit.get("upper", 0.0)))
            for name, joint in movable.items()
            if joint.get("type") != "continuous" and (limit := joint.find("limit")) is not None
        }
    except (ElementTree.ParseError, ValueError) as error:
        raise PoseError(f"it is not a URDF: {error}") from error
    for name in joints:
        if name not in movable:
            existing = ", ".join(movable) or "none"
            raise PoseError(f"no movable joint '{name}'; the robot has {existing}")
    return {name: bounds[name] for name in joints if name in bounds}


def check_limits(pose: Pose, joints: Sequence[str], limits: Limits) -> None:
    """Check that the robot can reach a pose.

    Raises:
        PoseError: a position is beyond its joint's limits; the message names both.
    """
    for name, position in zip(joints, pose, strict=True):
        lower, upper = limits.get(name, (-math.inf, math.inf))
        if not lower <= position <= upper:
            raise PoseError(
                f"joint '{name}' cannot go to {position:g}: its limits are {lower:g} to {upper:g}"
            )


def read_pose_file(path: Path, joints: Sequence[str]) -> list[Pose]:
    """Return the poses of a YAML file, at least one.

        poses:
          - [0.5, 0.5, 0.5, 0.5]
          - [0.0, 0.0, 0.0, 0.0]

    Raises:
        PoseFileError: the file is missing, not YAML, or not a list of poses; the message names the
            file and the line.
    """
    # A FIFO or a device would block.
    if not path.is_file():
        what = "is not a regular file" if path.exists() else "does not exist"
        raise PoseFileError(f"the pose file {path} {what}")
    try:
        # Nodes instead of values, because only nodes know their line.
        root = yaml.compose(path.read_text(), yaml.SafeLoader)
    except (OSError, UnicodeDecodeError) as error:
        raise PoseFileError(f"cannot read the pose file {path}: {error}") from error
    except (yaml.YAMLError, RecursionError) as error:
        raise PoseFileError(f"{path} is not YAML: {' '.join(str(error).split())}") from error
    if not isinstance(root, yaml.MappingNode) or not root.value:
        raise PoseFileError(f"{path} must have the key 'poses' with a list of poses")
    poses: list[yaml.Node] = []
    for key, value in root.value:
        place = f"{path}, line {key.start_mark.line + 1}"
        if key.value != "poses":
            raise PoseFileError(f"{place}: unknown key {key.value!r}; the only key is 'poses'")
        if not isinstance(value, yaml.SequenceNode) or not value.value:
            raise PoseFileError(f"{place}: 'poses' must be a list of poses")
        poses = value.value
    return [_read_pose(node, path, joints) for node in poses]


def _read_pose(node: yaml.Node, path: Path, joints: Sequence[str]) -> Pose:
    place = f"{path}, line {node.start_mark.line + 1}"
    items = node.value if isinstance(node, yaml.SequenceNode) else None
    try:
        # YAML 1.1 reads 1e-3 as a text, so Python decides what is a number.
        values = [float(item.value) for item in items or ()]
    except (TypeError, ValueError) as error:
        raise PoseFileError(f"{place}: a pose is made of numbers; {error}") from error
    if items is None:
        raise PoseFileError(f"{place}: a pose is a list of {len(joints)} numbers")
    try:
        return read_pose(values, joints)
    except PoseError as error:
        raise PoseFileError(f"{place}: {error}") from error
