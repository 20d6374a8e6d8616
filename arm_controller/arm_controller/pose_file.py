"""Reads the file of poses for publisher_defined.

    poses:
      - [0.5, 0.5, 0.5, 0.5]
      - [0.0, 0.0, 0.0, 0.0]

It uses YAML nodes instead of values, because only nodes know their line.
"""

from collections.abc import Sequence
from pathlib import Path

import yaml

from arm_controller.pose import ArmControllerError, Pose, PoseError, read_pose
from arm_node.limited_yaml import YamlError, compose_yaml
from arm_node.user_file import read_text

POSES_KEY = "poses"


class PoseFileError(ArmControllerError):
    """A file of poses is missing, unreadable or invalid; the message names file and line."""


def read_pose_file(path: Path, joints: Sequence[str]) -> tuple[Pose, ...]:
    """Return the poses of a file, at least one.

    Args:
        path: the YAML file.
        joints: the joints of each pose, in its order.

    Raises:
        PoseFileError: the file is missing, not YAML, or not a list of poses; the message names the
            file and the line.
    """
    try:
        text = read_text(path)
    except FileNotFoundError as error:
        raise PoseFileError(f"the pose file {path} does not exist") from error
    except (OSError, UnicodeDecodeError) as error:
        raise PoseFileError(f"cannot read the pose file {path}: {error}") from error
    try:
        root = compose_yaml(text)
    except YamlError as error:
        raise PoseFileError(f"{path} is not YAML: {error}") from error
    return tuple(_pose(item, path, joints) for item in _pose_items(root, path))


def _pose_items(root: yaml.Node | None, path: Path) -> list[yaml.Node]:
    if not isinstance(root, yaml.MappingNode):
        raise PoseFileError(f"{path} must have the key '{POSES_KEY}' with a list of poses")
    items: list[yaml.Node] | None = None
    for key, value in root.value:
        if key.value != POSES_KEY:
            raise PoseFileError(
                f"{_place(key, path)}: unknown key '{key.value}'; the only key is '{POSES_KEY}'"
            )
        if not isinstance(value, yaml.SequenceNode):
            raise PoseFileError(f"{_place(value, path)}: '{POSES_KEY}' must be a list of poses")
        items = value.value
    if not items:
        raise PoseFileError(f"{path} has no pose under the key '{POSES_KEY}'")
    return items


def _pose(item: yaml.Node, path: Path, joints: Sequence[str]) -> Pose:
    if not isinstance(item, yaml.SequenceNode):
        raise PoseFileError(
            f"{_place(item, path)}: a pose is a list of {len(joints)} numbers, "
            f"such as [{', '.join('0.0' for _ in joints)}]"
        )
    try:
        return read_pose([_number(value, path) for value in item.value], joints)
    except PoseError as error:
        raise PoseFileError(f"{_place(item, path)}: {error}") from error


def _number(node: yaml.Node, path: Path) -> float:
    # YAML 1.1 reads 1e-3 as a string, so Python decides what is a number.
    if isinstance(node, yaml.ScalarNode) and not node.style:
        try:
            return float(node.value)
        except ValueError:
            pass
    shown = f"'{node.value}'" if isinstance(node, yaml.ScalarNode) else "a list or mapping"
    raise PoseFileError(f"{_place(node, path)}: a pose is made of numbers; {shown} is not one")


def _place(node: yaml.Node, path: Path) -> str:
    return f"{path}, line {node.start_mark.line + 1}"
