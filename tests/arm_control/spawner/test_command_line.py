"""The command lines of unspawner and hardware_spawner, and what they share with spawner's."""

import pytest

from arm_control.lifecycle import LifecycleState
from arm_control.manager.node_arguments import parameter_files, split_ros_arguments
from arm_control.spawner.command_line import (
    ControllerOptions,
    HardwareSpawnerOptions,
    SpawnerOptions,
    UnspawnerOptions,
    absolute_name,
    parse_hardware_spawner_options,
    parse_spawner_options,
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


def parse(line: str, *more: str) -> SpawnerOptions:
    return parse_spawner_options([*line.split(), *more])


def test_defaults_are_those_of_ros2_control():
    options = parse_spawner_options(["a", "b"])
    assert options.controllers == (ControllerOptions("a"), ControllerOptions("b"))
    assert options.controller_manager == "controller_manager"
    assert options.controller_manager_timeout_s == 0.0
    assert options.switch_timeout_s == 5.0
    assert options.service_call_timeout_s == 10.0
    assert options.switch_asap
    assert not any((options.unload_on_kill, options.activate_as_group, options.namespace))


def test_files_and_arguments_may_be_given_several_times():
    more = ("--controller-ros-args", "-r b:=c -r d:=e", "--controller-ros-args", "-p f:=1")
    (controller,) = parse("a -p x --param-file y", *more).controllers
    assert controller.param_files == ("x", "y")
    assert controller.ros_args == ("-r", "b:=c", "-r", "d:=e", "-p", "f:=1")


def test_options_apply_to_every_name():
    options = parse_spawner_options(["a", "--load-only", "b", "-p", "x", "-u"])
    assert options.controllers == tuple(
        ControllerOptions(name, ("x",), configure=False, activate=False, unload_on_kill=True)
        for name in "ab"
    )


def test_the_manager_and_time_outs_can_be_chosen():
    options = parse_spawner_options(
        ["-c", "/m", "a", "--controller-manager-timeout", "1", "--no-switch-asap", "-u", "-n", "x"]
    )
    assert (options.controller_manager, options.controller_manager_timeout_s) == ("/m", 1.0)
    assert (options.switch_asap, options.unload_on_kill, options.namespace) == (False, True, "x")


def test_a_controller_can_have_its_own_options():
    options = parse(
        "--controller a --inactive -p x -c m --controller b -p y --load-only -p z "
        "--controller=c --activate-as-group"
    )
    assert options.controllers == (
        ControllerOptions("a", ("x",), activate=False),
        ControllerOptions("b", ("y", "z"), configure=False, activate=False),
        ControllerOptions("c"),
    )
    assert (options.controller_manager, options.activate_as_group) == ("m", True)


def test_an_option_after_an_option_of_all_is_still_of_the_controller_named_last():
    options = parse("--controller a --controller b -c m --controller-manager-timeout 1 -p x")
    assert [controller.param_files for controller in options.controllers] == [(), ("x",)]


def test_options_before_the_first_controller_apply_to_all():
    options = parse(
        "-p x --inactive --controller a --controller b --controller-ros-args", "-p q:=1"
    )
    assert options.controllers == (
        ControllerOptions("a", ("x",), activate=False),
        ControllerOptions("b", ("x",), ("-p", "q:=1"), activate=False),
    )


@pytest.mark.parametrize(
    ("arguments", "unloaded"),
    [
        ("--controller a --inactive --controller b -u", [False, True]),
        ("a b --inactive -u", [True, True]),
        ("--controller a --controller b", [False, False]),
    ],
)
def test_what_the_end_unloads(arguments, unloaded):
    options = parse(arguments)
    assert [controller.unload_on_kill for controller in options.controllers] == unloaded


def test_files_of_the_spawners_node_serve_every_controller_last():
    arguments = ["--controller", "a", "-p", "x", "--controller", "b"]
    options = parse_spawner_options(arguments, ["f"])
    assert [controller.param_files for controller in options.controllers] == [("x", "f"), ("f",)]


@pytest.mark.parametrize(
    "arguments",
    [
        [],
        ["-c", "m"],
        ["a", "--controller", "b"],
        ["--controller"],
        ["a", "--controller-ros-args"],
        ["a", "--nonsense"],
        ["a", "--switch-timeout", "-1"],
        ["a", "--switch-timeout", "soon"],
        ["a", "--switch-timeout", "nan"],
        ["a", "--service-call-timeout", "0"],
    ],
)
def test_a_wrong_command_line_ends_with_code_2(arguments, capsys):
    with pytest.raises(SystemExit) as end:
        parse_spawner_options(arguments)
    assert end.value.code == 2
    assert "spawner: error:" in capsys.readouterr().err
