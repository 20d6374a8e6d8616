"""Reads the folder of a MoveIt configuration into move_group's parameters.

The files are those of MoveIt's configuration packages: ROBOT.srdf, kinematics.yaml,
joint_limits.yaml, pilz_cartesian_limits.yaml, moveit_controllers.yaml, sensors_3d.yaml and
PIPELINE_planning.yaml.
"""

from collections.abc import Mapping
from pathlib import Path
from typing import Any

from arm_node.limited_yaml import YamlError, load_yaml
from arm_node.user_file import read_text
from arm_planning.errors import SettingError

PLANNING = "robot_description_planning"
SEMANTIC = "robot_description_semantic"
SERVO = "moveit_servo"
KINEMATICS = "robot_description_kinematics"
CONTROLLER_FILES = ("moveit_controllers.yaml", "moveit2_controllers.yaml")
SENSORS_FILE = "sensors_3d.yaml"
PIPELINE_SUFFIX = "_planning.yaml"


def move_group_parameters(folder: Path, *, octomap: bool = False) -> dict[str, Any]:
    """Return the parameters that a configuration folder stands for, nested as in YAML.

    Args:
        folder: has the files, itself or in its folder `config`. A file that it lacks is left out.
        octomap: take the sensors that make an octomap, too.

    Raises:
        PlanningError: the folder has no such file at all, several SRDFs, or a file is not what it
            should be.
    """
    place = folder / "config" if (folder / "config").is_dir() else folder
    semantic = sorted(place.glob("*.srdf"))
    if len(semantic) > 1:
        names = ", ".join(path.name for path in semantic)
        raise SettingError(f"{place} has several SRDFs: {names}; give the folder of one robot")
    parameters: dict[str, Any] = {}
    if semantic:
        parameters[SEMANTIC] = _text(semantic[0])
    if kinematics := _yaml(place / "kinematics.yaml"):
        parameters[KINEMATICS] = kinematics
    limits = {
        **_yaml(place / "joint_limits.yaml"),
        **_yaml(place / "pilz_cartesian_limits.yaml"),
    }
    if limits:
        parameters[PLANNING] = limits
    for name in CONTROLLER_FILES:
        parameters.update(_yaml(place / name))
    if octomap:
        sensors = _yaml(place / SENSORS_FILE)
        if not sensors.get("sensors"):
            raise SettingError(f"octomap:=true needs {place / SENSORS_FILE} with a list of sensors")
        parameters.update(sensors)
    for path in sorted(place.glob(f"*{PIPELINE_SUFFIX}")):
        parameters[path.name.removesuffix(PIPELINE_SUFFIX)] = _yaml(path)
    if not parameters:
        raise SettingError(
            f"{place} has no MoveIt configuration: no .srdf, kinematics.yaml, joint_limits.yaml "
            "or moveit_controllers.yaml"
        )
    return parameters


def servo_parameters(path: Path) -> dict[str, Any]:
    """Return the parameters of servo_node in a file as moveit_servo's users write it.

    Args:
        path: YAML: the parameters at the top, or below `moveit_servo`.

    Raises:
        PlanningError: there is no such file, or it has no parameters.
    """
    if not path.is_file():
        raise SettingError(f"there is no file {path}")
    values = _yaml(path)
    return {SERVO: values.get(SERVO, values)}


def _yaml(path: Path) -> Mapping[str, Any]:
    if not path.is_file():
        return {}
    try:
        values = load_yaml(_text(path))
    except YamlError as error:
        raise SettingError(f"{path}: {error}") from error
    if values is None:
        return {}
    if not isinstance(values, Mapping):
        raise SettingError(f"{path} is not a mapping of names to values")
    # A file for ros2 run has one more level around the values.
    node = values.get("/**", values)
    return node.get("ros__parameters", node) if isinstance(node, Mapping) else {}


def _text(path: Path) -> str:
    try:
        return read_text(path)
    except (OSError, UnicodeDecodeError) as error:
        raise SettingError(f"cannot read {path}: {error}") from error
