"""The spawner's command line."""

import pytest

from arm_control.spawner.command_line import (
    ControllerOptions,
    SpawnerOptions,
    parse_spawner_options,
)


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
