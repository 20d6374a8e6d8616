"""The command lines of unspawner and hardware_spawner, and what they share with spawner's."""

import pytest

from arm_control.lifecycle import LifecycleState
from arm_control.manager.node_arguments import parameter_files, split_ros_arguments
from arm_control.spawner.command_line import (
    HardwareSpawnerOptions,
    UnspawnerOptions,
    absolute_name,
    parse_hardware_spawner_options,
    parse_unspawner_options,
)


@pytest.mark.parametrize(
    ("argv", "own", "ros"),
    [
        (["a"], ["a"], []),
        (["a", "--ros-args", "-r", "x:=y"], ["a"], ["--ros-args", "-r", "x:=y"]),
        (["--ros-args", "-r", "x:=y", "--", "a"], ["a"], ["--ros-args", "-r", "x:=y", "--"]),
    ],
)
def test_ros_arguments_are_parted_off(argv, own, ros):
    assert split_ros_arguments(argv) == (own, ros)


def test_parameter_files_of_the_node_are_found():
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
def test_a_relative_manager_is_looked_for_in_the_namespace(manager, namespace, expected):
    assert absolute_name(manager, namespace) == expected


def test_names_and_options_of_unspawner_may_be_mixed():
    assert parse_unspawner_options(["a", "-c", "/m", "b"]) == UnspawnerOptions(
        ("a", "b"), "/m", 5.0
    )
    assert parse_unspawner_options(["a", "--switch-timeout", "0.5"]) == UnspawnerOptions(
        ("a",), "controller_manager", 0.5
    )


@pytest.mark.parametrize("arguments", [[], ["a", "--switch-timeout", "-1"], ["a", "--force"]])
def test_a_wrong_command_line_of_unspawner_ends_with_code_2(arguments, capsys):
    with pytest.raises(SystemExit) as end:
        parse_unspawner_options(arguments)
    assert end.value.code == 2
    assert "unspawner: error:" in capsys.readouterr().err


def test_hardware_spawner_needs_a_target():
    assert parse_hardware_spawner_options(["a", "b", "--activate"]) == HardwareSpawnerOptions(
        ("a", "b"), LifecycleState.ACTIVE, "controller_manager", 0.0
    )
    arguments = ["a", "--configure", "-c", "m", "--controller-manager-timeout", "2.5"]
    assert parse_hardware_spawner_options(arguments) == HardwareSpawnerOptions(
        ("a",), LifecycleState.INACTIVE, "m", 2.5
    )


@pytest.mark.parametrize(
    "arguments", [[], ["a"], ["--activate"], ["a", "--activate", "--configure"], ["-c", "m"]]
)
def test_a_wrong_command_line_of_hardware_spawner_ends_with_code_2(arguments, capsys):
    with pytest.raises(SystemExit) as end:
        parse_hardware_spawner_options(arguments)
    assert end.value.code == 2
    assert "hardware_spawner: error:" in capsys.readouterr().err
