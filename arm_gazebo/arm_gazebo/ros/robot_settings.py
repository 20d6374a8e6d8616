"""The parameters of the simulation node that are about one robot of it."""

from dataclasses import dataclass
from pathlib import Path

from arm_description.robot import Pose
from arm_gazebo.ros.parameter_values import ParameterValues

BASES = ("fixed", "free")


@dataclass(frozen=True, slots=True)
class RobotSettings:
    """What the user chooses about one robot.

    Attributes:
        namespace: of its controller manager, "" for the process's own.
        robot_description: the URDF.
        spawn: controllers to start with the simulation, in this order.
        spawn_required: whether one of them that cannot start is an error, or left out.
        base: what becomes of a root link that hangs on no world link.
        pose: of the robot's root in the world; None for where it stands by itself.
        package_path: folders searched for package:// and model:// besides the installed ones.
    """

    namespace: str
    robot_description: str
    spawn: tuple[str, ...]
    spawn_required: bool
    base: str
    pose: Pose | None
    package_path: tuple[Path, ...]


def read_robots(values: ParameterValues) -> tuple[RobotSettings, ...]:
    """Return the robots: the one whose parameters are the node's, or those that `robots` names.

    The parameters of a named one stand below its name, which is its namespace, too.

    Raises:
        SettingsError: a value makes no sense, or a name stands for two.
    """
    names = values.texts("robots", "namespaces of several robots; none for a single one")
    if not names:
        return (_read_robot(values, ""),)
    twice = next((name for name in names if names.count(name) > 1), None)
    if twice is not None:
        raise values.error("robots", f"names '{twice}' twice; each has a namespace of its own")
    return tuple(_read_robot(values.below(name), name) for name in names)


def _read_robot(values: ParameterValues, namespace: str) -> RobotSettings:
    return RobotSettings(
        namespace=namespace,
        robot_description=_description(values),
        spawn=tuple(values.texts("spawn", "controllers to start with the simulation")),
        spawn_required=values.flag(
            "spawn_required", True, "a controller that cannot start ends the simulation"
        ),
        base=values.choice("base", "fixed", BASES, "what a root without world link does"),
        pose=_pose(values),
        package_path=values.folders("package_path", "for package:// and model://, with colons"),
    )


def _description(values: ParameterValues) -> str:
    text = values.text("robot_description", "", "the URDF")
    if not text.strip():
        raise values.error(
            "robot_description",
            "is empty; give it the URDF of the robot, as sim.launch.py does",
        )
    return text


def _pose(values: ParameterValues) -> Pose | None:
    numbers = values.numbers("pose", "x y z roll pitch yaw of the robot's root, in m and rad")
    if not numbers:
        return None
    if len(numbers) != 6:
        raise values.error(
            "pose", f"takes six numbers, x y z roll pitch yaw, or none; it has {len(numbers)}"
        )
    x, y, z, roll, pitch, yaw = numbers
    return Pose((x, y, z), (roll, pitch, yaw))
