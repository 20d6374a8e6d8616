"""The spawner's command line."""

import pytest

from arm_control.spawner_options import parse_spawner_options, split_ros_arguments


def test_defaults_are_those_of_ros2_control() -> None:
    options = parse_spawner_options(["a", "b"])
    assert options.names == ("a", "b")
    assert options.controller_manager == "controller_manager"
    assert options.controller_manager_timeout_s == 0.0
    assert options.switch_timeout_s == 5.0
    assert options.service_call_timeout_s == 10.0
    assert options.switch_asap
    flags = (options.load_only, options.inactive, options.unload_on_kill, options.activate_as_group)
    assert not any(flags)


def test_files_and_arguments_may_be_given_several_times() -> None:
    options = parse_spawner_options(
        ["a", "-p", "x", "--param-file", "y", "--controller-ros-args", "-r b:=c"]
    )
    assert options.param_files == ("x", "y")
    assert options.controller_ros_args == ("-r", "b:=c")


def test_the_manager_and_time_outs_can_be_chosen() -> None:
    options = parse_spawner_options(
        ["a", "-c", "/m", "--controller-manager-timeout", "1", "--no-switch-asap", "-u"]
    )
    assert (options.controller_manager, options.controller_manager_timeout_s) == ("/m", 1.0)
    assert (options.switch_asap, options.unload_on_kill) == (False, True)


@pytest.mark.parametrize(
    "arguments",
    [
        [],
        ["a", "--nonsense"],
        ["a", "--switch-timeout", "-1"],
        ["a", "--switch-timeout", "soon"],
        ["a", "--service-call-timeout", "0"],
    ],
)
def test_a_wrong_command_line_ends_with_code_2(
    arguments: list[str], capsys: pytest.CaptureFixture[str]
) -> None:
    with pytest.raises(SystemExit) as end:
        parse_spawner_options(arguments)
    assert end.value.code == 2
    assert "spawner: error:" in capsys.readouterr().err


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
