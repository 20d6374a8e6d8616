"""arm_control.launch.py: which spawners it starts, and for which controller manager."""

import os

import pytest

from arm_control.course import course_file
from arm_description.resources import resolve_uri
from launch_py.errors import UsageError
from launch_py.launch_description import expand_description
from launch_py.launch_description_sources import read_launch_file

ROS1_NAMES = ["j0p_controller", "j1p_controller", "j2p_controller", "j3p_controller"]


def spawned(**arguments: str) -> list[tuple[list[str], str, str]]:
    """Return the controllers, the manager and the parameter file of each spawner."""
    path = resolve_uri("package://arm_control/launch/arm_control.launch.py")
    plan = expand_description(read_launch_file(path), arguments, os.environ, path)
    found: list[tuple[list[str], str, str]] = []
    for step in plan.processes:
        words = [str(word) for word in step.command]
        manager, file = words.index("--controller-manager"), words.index("--param-file")
        names = [word for word in words[:manager] if word.endswith(("_controller", "_broadcaster"))]
        found.append((names, words[manager + 1], words[file + 1]))
    return found


def test_the_broadcaster_comes_before_the_controllers():
    for given, manager, controllers in (
        ({}, "/controller_manager", ["position_controller"]),
        ({"interface": "ros1"}, "/arm/controller_manager", ROS1_NAMES),
    ):
        first, second = spawned(**given)
        assert first[:2] == (["joint_state_broadcaster"], manager)
        assert second[:2] == (controllers, manager)


def test_the_arguments_of_ros_1_are_taken():
    names = ["joint_state_broadcaster", *ROS1_NAMES]
    found = spawned(
        course="S3",
        robot_name="left",
        controllers=" ".join(names),
        hardware_interface="hardware_interface/PositionJointInterface",
    )
    assert found == [(names, "/left/controller_manager", str(course_file("S3")))]
    with pytest.raises(UsageError, match="'hardware_interface' cannot be 'EffortJointInterface'"):
        spawned(hardware_interface="EffortJointInterface")


def test_named_controllers_without_a_course_have_the_default_parameter_file():
    ((names, manager, file),) = spawned(controllers="position_controller")
    assert (names, manager) == (["position_controller"], "/controller_manager")
    assert file == str(resolve_uri("package://arm_control/config/arm_control.yaml"))


def test_a_parameter_file_is_passed_to_every_spawner():
    assert [file for _, _, file in spawned(controllers="my/own.yaml")] == ["my/own.yaml"] * 2
