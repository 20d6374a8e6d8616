"""The settings of one robot, each declared once; see `arm_node.setting`."""

import os
from array import array
from dataclasses import dataclass
from pathlib import Path
from typing import TYPE_CHECKING

from arm_node.parameter_values import ParameterValueError, read_numbers, read_text, read_words
from arm_node.setting import Parameters, read_settings, setting

if TYPE_CHECKING:
    from arm_description.urdf.robot import Pose


def _read_description(value: object) -> str:
    text = read_text(value)
    if not text.strip():
        raise ParameterValueError("is empty; set it to the robot's URDF, as sim.launch.py does")
    return text


def _read_pose(value: object) -> "Pose | None":
    numbers = read_numbers([] if isinstance(value, str) and not value else value)
    if not numbers:
        return None
    if len(numbers) != 6:
        raise ParameterValueError(
            f"takes six numbers, x y z roll pitch yaw, or none; it has {len(numbers)}"
        )
    # Imported here, because launch files read the declarations, and need no robot for that.
    from arm_description.urdf.robot import Pose

    x, y, z, roll, pitch, yaw = numbers
    return Pose((x, y, z), (roll, pitch, yaw))


def _read_folders(value: object) -> tuple[Path, ...]:
    return tuple(
        Path(folder).expanduser() for folder in read_text(value).split(os.pathsep) if folder
    )


@dataclass(frozen=True, slots=True, kw_only=True)
class RobotSettings:
    """The user's settings for one robot.

    Attributes:
        namespace: namespace of its controller manager, "" for the process's own.
    """

    namespace: str
    robot_description: str = setting("", "the URDF", _read_description, launches=False)
    spawn: tuple[str, ...] = setting(
        (), "controllers to start with the simulation, in this order", read_words, launches=False
    )
    spawn_required: bool = setting(
        True,
        "a controller that cannot start ends the simulation, instead of a warning",
        launches=False,
    )
    base: str = setting(
        "fixed",
        "how a root link other than 'world' is attached: bolted down, or standing free on its foot",
        choices=("fixed", "free"),
    )
    pose: "Pose | None" = setting(
        array("d"),
        'pose of the root in the world, in m and rad: "[x, y, z, roll, pitch, yaw]"',
        _read_pose,
    )
    on_floor: bool = setting(
        False, "a free robot stands on the floor at its pose, whatever its z", launches=False
    )
    package_path: tuple[Path, ...] = setting(
        "",
        "folders for package:// and $(find ...), separated by colons; searched after the model's "
        "own package and before its neighbours and the installed packages",
        _read_folders,
    )


def read_robots(parameters: Parameters) -> tuple[RobotSettings, ...]:
    """Return the single robot, or the robots that the parameter `robots` names.

    The name of a robot is the prefix of its parameters, and its namespace.

    Raises:
        ParameterValueError: a value is invalid, or a name occurs twice.
    """
    names = parameters(
        "robots", (), read_words, "namespaces of several robots; none for a single one"
    )
    twice = next((name for name in names if names.count(name) > 1), None)
    if twice is not None:
        raise ParameterValueError(f"robots names '{twice}' twice; each needs its own namespace")
    prefixes = {name: f"{name}." for name in names} or {"": ""}
    return tuple(
        read_settings(RobotSettings, parameters, prefix, namespace=name)
        for name, prefix in prefixes.items()
    )
