"""Prepare a robot for simulation: its description, its controllers and its folders."""

import os
from collections.abc import Mapping
from pathlib import Path
from typing import TYPE_CHECKING, Any

from arm_description.resources import ResourceFinder
from arm_description.xacro.expansion import XacroExpansion, arguments_of_text, expand_xacro_file
from arm_gazebo.errors import SimSettingsError
from arm_gazebo.launching.controllers_file import (
    Controllers,
    checked_controllers,
    startable_controllers,
    substitute_arguments,
)
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
from arm_node.frozen import frozen

if TYPE_CHECKING:
    from arm_description.urdf.description import RobotDescription

SPAWN_AUTO = "auto"
"""Start every controller whose joints are not claimed yet."""


@frozen
class RobotSetup:
    """A robot, ready to be simulated.

    Attributes:
        description: URDF text with a <ros2_control> block.
        controllers: a parameter file, or its content.
        spawn: controllers to start with the simulation.
        spawn_required: whether the user named them, so that a failure to start one is an error.
        package_path: folders that the user named for the description's files.
        remarks: one sentence for each default that was added.
        left_out: one sentence that counts and names the controllers of types that the suite does
            not have; empty if there are none.
    """

    description: str
    controllers: Controllers
    spawn: tuple[str, ...]
    spawn_required: bool
    package_path: tuple[Path, ...]
    remarks: tuple[str, ...]
    left_out: str = ""

    def parameters(self) -> dict[str, str | bool]:
        """Return the simulation node's parameters for the robot."""
        return {
            "robot_description": self.description,
            "spawn": ",".join(self.spawn),
            "spawn_required": self.spawn_required,
            "package_path": os.pathsep.join(map(str, self.package_path)),
        }


def set_up_robot(
    model: str,
    model_args: str = "",
    controllers: str | Mapping[str, Any] = "",
    spawn: str = SPAWN_AUTO,
    package_path: str = "",
    commander: str = COMMANDER,
) -> RobotSetup:
    """Read a robot and add defaults for what it lacks.

    Args:
        model: URDF or xacro file, also as a package:// URI; or the text of a URDF.
        model_args: xacro arguments, "a:=1 b:=2".
        controllers: parameter file, also as a package:// URI, in which ${name} stands for an
            argument of the model, or its content; "" for the default controllers.
        spawn: controllers, separated by commas; "auto" for every controller that can start on
            this robot and whose joints are not claimed yet.
        package_path: folders, separated by colons.
        commander: the default controller that drives the joints, COMMANDER or TRAJECTORY.

    Raises:
        SimSettingsError: an argument is invalid.
        DescriptionError: the model does not exist, or is not a robot.
    """
    given = folders(package_path)
    expansion = _expanded(model, arguments_of_text(model_args), given)
    text = expansion.text
    remarks: list[str] = []
    joints, named_files = HardwareJoints(), list[str]()
    if not has_hardware(text) or not controllers:
        # Only in this case, so that a complete robot is not parsed twice.
        description, joints = _completed(expansion, remarks)
        text, named_files = description.text, gz_parameter_files(description)
    if isinstance(controllers, Mapping):
        content = checked_controllers(controllers, "the controllers' parameters")
    elif controllers:
        content = substitute_arguments(path_of(controllers, expansion.finder), expansion.arguments)
    else:
        content = default_parameters(joints)
        remarks.append(f"no controllers are given: {_describe_defaults(joints, commander)}")
        remarks += (
            f"the description names a file for Gazebo's plugin; to use it: controllers:={file}"
            for file in named_files
        )
    defaults = default_controllers(joints, commander)
    spawned, left_out = _spawned(spawn, content if controllers else None, defaults, remarks)
    required = spawn.strip() != SPAWN_AUTO
    return RobotSetup(text, content, spawned, required, given, tuple(remarks), left_out)


def _expanded(
    model: str, arguments: Mapping[str, str], package_path: tuple[Path, ...]
) -> XacroExpansion:
    """Return the URDF of a file or of a text."""
    if not model.lstrip().startswith("<"):
        file = path_of(model, ResourceFinder(None, package_path))
        return expand_xacro_file(file, arguments, package_path)
    if "xmlns:xacro" in model:
        raise SimSettingsError("a xacro model is given by its file, which may include others")
    return XacroExpansion(model, arguments, ResourceFinder(None, package_path), "the description")


def path_of(file: str, finder: ResourceFinder) -> Path:
    """Return the path of a file that is given as a path or a URI.

    Raises:
        ResourceNotFoundError: the URI does not exist.
    """
    return finder.find(file) if "://" in file else Path(file).expanduser()


def folders(path: str) -> tuple[Path, ...]:
    """Split a text at the colons into folders."""
    return tuple(Path(folder).expanduser() for folder in path.split(os.pathsep) if folder.strip())


def _completed(
    expansion: XacroExpansion, remarks: list[str]
) -> "tuple[RobotDescription, HardwareJoints]":
    """Return the description with hardware, and the joints by their interfaces."""
    # Imported here, because a complete robot is not parsed by the launcher.
    from arm_control.hardware.info import parse_hardware_info
    from arm_description.urdf.description import RobotDescription
    from arm_description.urdf.parser import ignore_remark, parse_urdf

    description = RobotDescription(expansion.text, expansion.source)
    robot = parse_urdf(description, remark=ignore_remark)
    if not has_hardware(description.text):
        joints = commandable_joints(robot)
        remarks.append(
            f"robot '{robot.name}' has no <ros2_control> block: a default one commands "
            f"{', '.join(joints) or 'nothing, because no joint can be commanded'}"
        )
        description = RobotDescription(with_hardware(description.text, robot))
    return description, hardware_joints(robot, parse_hardware_info(description))


def _describe_defaults(joints: HardwareJoints, commander: str) -> str:
    names = default_controllers(joints, commander)
    clauses = [
        f"the default is {' and '.join(names)}" if names else "there is no default for this robot"
    ]
    if joints.position_commanded:
        clauses.append(f"{commander} drives {', '.join(joints.position_commanded)}")
    if joints.otherwise_commanded:
        clauses.append(
            f"nothing drives {', '.join(joints.otherwise_commanded)}, which the hardware does not "
            "command by position; to move them, give a file with a controller for them: "
            "controllers:=FILE"
        )
    return "; ".join(clauses)


def gz_parameter_files(description: "RobotDescription") -> list[str]:
    """Return the parameter files that a description names for gz_ros2_control."""
    files = [named.content for named in description.root.find("gazebo/plugin/parameters")]
    return [file for file in files if os.path.isfile(file)]


def _spawned(
    spawn: str,
    controllers: Controllers | None,
    defaults: tuple[str, ...],
    remarks: list[str],
) -> tuple[tuple[str, ...], str]:
    """Return the controllers to start, and a sentence about those that the suite does not have."""
    if spawn.strip() != SPAWN_AUTO:
        return tuple(name for name in spawn.replace(",", " ").split()), ""
    if controllers is None:
        return defaults, ""
    from arm_control.manager.registry import controller_types

    startable = startable_controllers(controllers, frozenset(controller_types()))
    remarks += startable.remarks
    return startable.names, _left_out(startable.missing)


def _left_out(missing: Mapping[str, str]) -> str:
    if not missing:
        return ""
    count = f"{len(missing)} controller{'s are' if len(missing) > 1 else ' is'} left out"
    named = ", ".join(f"{name} ({type_name})" for name, type_name in missing.items())
    return f"{count}, because the suite has no controller of the type: {named}"
