"""What the clients' command lines have in common."""

import pytest

from arm_control.manager_command_line import absolute_name, parameter_files, split_ros_arguments


@pytest.mark.parametrize(
    ("argv", "own", "ros"),
    [
        (["a"], ["a"], []),
        (["a", "--ros-args", "-r", "x:=y"], ["a"], ["--ros-args", "-r", "x:=y"]),
        (["--ros-args", "-r", "x:=y", "--", "a"], ["a"], ["--ros-args", "-r", "x:=y", "--"]),
    ],
)
def test_ros_arguments_are_parted_off(argv: list[str], own: list[str], ros: list[str]) -> None:
    assert split_ros_arguments(argv) == (own, ros)


def test_parameter_files_of_the_node_are_found() -> None:
    ros = ["--ros-args", "--params-file", "a", "-p", "x:=1", "--params-file", "b", "--params-file"]
    assert parameter_files(ros) == ("a", "b")


@pytest.mark.parametrize(
    ("manager", "namespace", "expected"),
    [
        ("controller_manager", "/", "/controller_manager"),
        ("controller_manager", "/ns/inner", "/ns/inner/controller_manager"),
        ("controller_manager", "ns", "/ns/controller_manager"),
        ("/other/manager", "/ns", "/other/manager"),
    ],
)
def test_a_relative_manager_is_looked_for_in_the_namespace(
    manager: str, namespace: str, expected: str
) -> None:
    assert absolute_name(manager, namespace) == expected
