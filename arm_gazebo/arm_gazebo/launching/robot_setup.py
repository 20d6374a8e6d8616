"""What a launch file needs to simulate a robot: its description, its controllers, its folders."""

import os
from collections.abc import Sequence
from dataclasses import dataclass
from pathlib import Path

from arm_description.resources import folders_of, resolve_uri
from arm_description.xacro_arguments import arguments_of_text
from arm_description.xacro_expansion import expand_xacro_file
from arm_description.xml_document import parse_xml
from arm_gazebo.launching.controllers_file import Controllers, fill_in, startable_controllers
from arm_gazebo.launching.default_control import (
    COMMANDER,
    HardwareJoints,
    commandable_joints,
    default_controllers,
    default_parameters,
    hardware_joints,
    has_hardware,
    with_hardware,
)

SPAWN_AUTO = "auto"
"""Start every controller whose joints are free."""


@dataclass(frozen=True, slots=True)
class RobotSetup:
    """A robot, ready to be simulated.

    Attributes:
        description: URDF text with a <ros2_control> block.
        controllers: a parameter file, or the content of one.
        spawn: controllers to start with the simulation.
        spawn_required: whether the user named them, so that one that cannot start is an error.
        package_path: folders searched for the description's files.
        remarks: what was made up, one sentence each.
    """

    description: str
    controllers: Controllers
    spawn: tuple[str, ...]
    spawn_required: bool
    package_path: tuple[Path, ...]
    remarks: tuple[str, ...]

    def parameters(self) -> dict[str, str | bool]:
        """Return the parameters of the simulation's node that are about the robot."""
        return {
            "robot_description": self.description,
            "spawn": ",".join(self.spawn),
            "spawn_required": self.spawn_required,
            "package_path": os.pathsep.join(map(str, self.package_path)),
        }


def set_up_robot(
    model: str,
    model_args: str = "",
    controllers: str = "",
    spawn: str = SPAWN_AUTO,
    package_path: str = "",
) -> RobotSetup:
    """Read a robot and complete what it lacks.

    Args:
        model: URDF or xacro file, also as a package:// URI.
        model_args: xacro arguments, "a:=1 b:=2".
        controllers: parameter file, also as a package:// URI, in which ${name} stands for an
            argument of the model; "" makes one up.
        spawn: names with commas; "auto" for every controller whose joints are free and that can
            start on this robot.
        package_path: folders with colons.

    Raises:
        SettingsError: arguments that make no sense; DescriptionError: no such model, or it is no
            robot.
    """
    given = folders(package_path)
    file = path_of(model, given)
    expansion = expand_xacro_file(file, arguments_of_text(model_args), given)
    description = expansion.text
    remarks: list[str] = []
    joints = HardwareJoints()
    if not has_hardware(description) or not controllers:
        # Only here: a robot that comes with everything starts without being parsed twice.
        description, joints = _completed(description, file, remarks)
    if controllers:
        content = fill_in(path_of(controllers, (*given, *folders_of(file))), expansion.arguments)
    else:
        content = default_parameters(joints)
        remarks.append(f"no controllers are given: {_made_up(joints)}")
        remarks += (
            f"the description names some for Gazebo's plugin; to have them: controllers:={file}"
            for file in _files_for_gazebo(description)
        )
    return RobotSetup(
        description,
        content,
        _spawned(spawn, content if controllers else None, joints, remarks),
        spawn.strip() != SPAWN_AUTO,
        (*given, *folders_of(file)),
        tuple(remarks),
    )


def path_of(file: str, package_path: Sequence[Path] = ()) -> Path:
    """Return the path of a file that is named by a path or a URI.

    Args:
        file: what the user gave.
        package_path: folders in which packages are looked for, too.

    Raises:
        ResourceNotFoundError: there is nothing under the URI.
    """
    return resolve_uri(file, package_path) if "://" in file else Path(file).expanduser()


def folders(path: str) -> tuple[Path, ...]:
    """Return the folders of a text that parts them by colons."""
    return tuple(Path(folder).expanduser() for folder in path.split(os.pathsep) if folder.strip())


def _completed(description: str, file: Path, remarks: list[str]) -> tuple[str, HardwareJoints]:
    """Return the description with hardware, and what that does with the joints."""
    from arm_control.hardware_info import parse_hardware_info
    from arm_description.urdf import parse_urdf

    robot = parse_urdf(description, str(file))
    if not has_hardware(description):
        joints = commandable_joints(robot)
        remarks.append(
            f"robot '{robot.name}' has no <ros2_control> block: one is made up that commands "
            f"{', '.join(joints) or 'nothing, for no joint can be commanded'}"
        )
        description = with_hardware(description, robot)
    return description, hardware_joints(robot, parse_hardware_info(description))


def _made_up(joints: HardwareJoints) -> str:
    names = default_controllers(joints)
    clauses = [f"{' and '.join(names) or 'none'} {'are' if len(names) > 1 else 'is'} made up"]
    if joints.positioned:
        clauses.append(f"{COMMANDER} drives {', '.join(joints.positioned)}")
    if joints.driven_otherwise:
        clauses.append(
            f"nothing drives {', '.join(joints.driven_otherwise)}, which the hardware does not "
            "command by position; to move them, give a file with a controller for them: "
            "controllers:=FILE"
        )
    return "; ".join(clauses)


def _files_for_gazebo(description: str) -> list[str]:
    """Return the parameter files that a description hands to gz_ros2_control."""
    named = parse_xml(description).iterfind("gazebo/plugin/parameters")
    files = (str(element.text or "").strip() for element in named)
    return [file for file in files if os.path.isfile(file)]


def _spawned(
    spawn: str,
    controllers: Controllers | None,
    joints: HardwareJoints,
    remarks: list[str],
) -> tuple[str, ...]:
    if spawn.strip() != SPAWN_AUTO:
        return tuple(name for name in spawn.replace(",", " ").split())
    if controllers is None:
        return default_controllers(joints)
    from arm_control.registry import controller_types

    startable = startable_controllers(controllers, frozenset(controller_types()))
    remarks += startable.remarks
    return startable.names
