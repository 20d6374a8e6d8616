"""Settings of the courses on the 4-DOF arm: one parameter file for each course."""

from collections.abc import Mapping, MutableMapping
from functools import cache
from pathlib import Path
from typing import Any, Protocol

from ament_index_python.packages import get_package_share_directory

from arm_node.parameter_file import PARAMETERS, read_parameters

NO_COURSE = "none"
COURSES = ("S0", "S1", "S2", "S3")
LAUNCH_ARGUMENTS = "launch_arguments"
COURSE_ARGUMENT: Mapping[str, Any] = {
    "default_value": NO_COURSE,
    "description": "whose tutorial to follow: a file in arm_control/config/courses",
    "choices": [NO_COURSE, *COURSES],
}
"""How launch files declare the argument `course`."""
INTERFACE_ARGUMENT: Mapping[str, Any] = {
    "default_value": "ros2",
    "description": "one controller for all joints, or as in ROS 1 one for each under /arm",
    "choices": ["ros2", "ros1"],
}
"""How launch files declare the argument `interface`."""
HARDWARE_INTERFACES = ("PositionJointInterface", "hardware_interface/PositionJointInterface")
HARDWARE_INTERFACE_ARGUMENT: Mapping[str, Any] = {
    "default_value": HARDWARE_INTERFACES[0],
    "description": "command interface of the joints, as in ROS 1",
    "choices": HARDWARE_INTERFACES,
}
"""How launch files declare the argument `hardware_interface` of ROS 1."""


class _LaunchContext(Protocol):
    """The part of a launch file's context that `take_course` uses."""

    @property
    def launch_configurations(self) -> MutableMapping[str, str]:
        """The values of the launch arguments, by name."""
        ...


def course_file(course: str) -> Path:
    """Return the parameter file of a course."""
    return (
        Path(get_package_share_directory("arm_control")) / "config" / "courses" / f"{course}.yaml"
    )


def launch_arguments(course: str) -> dict[str, str]:
    """Return the defaults that a course gives to launch arguments; empty for no course.

    Its file is also the file of the controllers and of the sample nodes' parameters.
    """
    if course == NO_COURSE:
        return {}
    path = str(course_file(course))
    own = course_parameters(course, LAUNCH_ARGUMENTS)
    return {"controllers": path, "params_file": path, **own}


def take_course(context: _LaunchContext) -> None:
    """Set the launch arguments that the user has not given from the course's file."""
    for name, value in launch_arguments(context.launch_configurations["course"]).items():
        context.launch_configurations.setdefault(name, value)


@cache
def course_parameters(course: str, node: str) -> Mapping[str, Any]:
    """Return the parameters that a course gives to a node of this name, in any namespace."""
    if course == NO_COURSE:
        return {}
    sections = read_parameters(course_file(course).read_text())
    own = {name.rpartition("/")[2]: section[PARAMETERS] for name, section in sections.items()}
    return own.get(node, {})
