"""The settings of one robot."""

import os
from array import array
from dataclasses import dataclass
from pathlib import Path
from typing import Protocol

from arm_description.urdf.robot import Pose
from arm_node.parameter_values import (
    ParameterValueError,
    Reader,
    Value,
    one_of,
    read_flag,
    read_numbers,
    read_text,
    read_words,
)

NO_NUMBERS = array("d")
BASES = ("fixed", "free")


class Parameters(Protocol):
    """A source of parameters: a node that declares them, or a program's own values."""

    def __call__(
        self,
        name: str,
        default: object,
        read: Reader[Value],
        description: str,
        /,
        *,
        read_only: bool = True,
    ) -> Value:
        """Return the value of a parameter, converted by `read`.

        Args:
            name: its name.
            default: its value if none is given.
            read: converts the value.
            description: one line on what it is for.
            read_only: whether it is fixed from the start.

        Raises:
            ParameterValueError: `read` refuses the value; the message names the parameter.
        """
        ...


@dataclass(frozen=True, slots=True)
class RobotSettings:
    """The user's settings for one robot.

    Attributes:
        namespace: namespace of its controller manager, "" for the process's own.
        robot_description: the URDF.
        spawn: controllers to start with the simulation, in this order.
        spawn_required: whether a controller that cannot start is an error instead of a warning.
        base: whether a root link other than `world` is fixed or free.
        pose: pose of the robot's root in the world; None for the default.
        package_path: folders searched for package:// and model:// after the description's own
            package, before its neighbours and the installed packages.
        on_floor: whether a free robot stands on the floor at its pose, whatever its z.
    """

    namespace: str
    robot_description: str
    spawn: tuple[str, ...]
    spawn_required: bool
    base: str
    pose: Pose | None
    package_path: tuple[Path, ...]
    on_floor: bool = False


def read_robots(value: Parameters) -> tuple[RobotSettings, ...]:
    """Return the single robot, or the robots that the parameter `robots` names.

    The name of a robot is the prefix of its parameters, and its namespace.

    Raises:
        ParameterValueError: a value is invalid, or a name occurs twice.
    """
    names = value("robots", (), read_words, "namespaces of several robots; none for a single one")
    if not names:
        return (_read_robot(value, ""),)
    twice = next((name for name in names if names.count(name) > 1), None)
    if twice is not None:
        raise ParameterValueError(f"robots names '{twice}' twice; each needs its own namespace")
    return tuple(_read_robot(value, name) for name in names)


def _read_robot(parameters: Parameters, namespace: str) -> RobotSettings:
    def value(name: str, default: object, read: Reader[Value], description: str) -> Value:
        full_name = f"{namespace}.{name}" if namespace else name
        return parameters(full_name, default, read, description)

    return RobotSettings(
        namespace=namespace,
        robot_description=value("robot_description", "", _read_description, "the URDF"),
        spawn=value("spawn", (), read_words, "controllers to start with the simulation"),
        spawn_required=value(
            "spawn_required", True, read_flag, "a controller that cannot start ends the simulation"
        ),
        base=value(
            "base",
            "fixed",
            one_of(BASES),
            f"how a root link other than 'world' is attached: {', '.join(BASES)}",
        ),
        pose=value(
            "pose", NO_NUMBERS, _read_pose, "x y z roll pitch yaw of the robot's root, in m and rad"
        ),
        on_floor=value(
            "on_floor", False, read_flag, "a free robot stands on the floor at its pose"
        ),
        package_path=value(
            "package_path",
            "",
            _read_folders,
            "folders for package:// and model://, separated by colons",
        ),
    )


def _read_description(value: object) -> str:
    text = read_text(value)
    if not text.strip():
        raise ParameterValueError("is empty; set it to the robot's URDF, as sim.launch.py does")
    return text


def _read_pose(value: object) -> Pose | None:
    numbers = read_numbers([] if isinstance(value, str) and not value else value)
    if not numbers:
        return None
    if len(numbers) != 6:
        raise ParameterValueError(
            f"takes six numbers, x y z roll pitch yaw, or none; it has {len(numbers)}"
        )
    x, y, z, roll, pitch, yaw = numbers
    return Pose((x, y, z), (roll, pitch, yaw))


def _read_folders(value: object) -> tuple[Path, ...]:
    return tuple(
        Path(folder).expanduser() for folder in read_text(value).split(os.pathsep) if folder
    )
