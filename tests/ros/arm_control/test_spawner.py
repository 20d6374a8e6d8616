"""The spawner as a program: what it does, what it says, how it ends."""

import signal
from collections.abc import Callable
from pathlib import Path
from typing import Any

import pytest
import yaml

pytestmark = pytest.mark.ros

POSITION = "position_controllers/JointGroupPositionController"
BROADCASTER = "joint_state_broadcaster/JointStateBroadcaster"


@pytest.fixture
def spawn(run: Any) -> Callable[..., Any]:
    """Return a function that starts a spawner."""
    return lambda *arguments: run("-m", "arm_control.spawner_node", *arguments)


@pytest.fixture
def file(tmp_path: Path) -> Callable[[dict[str, Any]], str]:
    """Return a function that writes a parameter file and returns its path."""

    def write(content: dict[str, Any]) -> str:
        path = tmp_path / "extra.yaml"
        path.write_text(yaml.safe_dump(content))
        return str(path)

    return write


def succeeded(program: Any) -> None:
    assert program.wait() == 0, program.output
    assert "Traceback" not in program.output


def failed(program: Any, code: int = 1) -> str:
    assert program.wait() == code, program.output
    assert "Traceback" not in program.output
    return program.output


def test_it_loads_configures_and_activates_in_order(control: Any, spawn: Any) -> None:
    spawner = spawn("joint_state_broadcaster", "position_controller")
    succeeded(spawner)
    assert control.states() == {
        "position_controller": "active",
        "joint_state_broadcaster": "active",
    }
    lines = [line.split("]: ")[-1] for line in spawner.lines[:-1]]
    assert lines == [
        "Loaded joint_state_broadcaster",
        "Configured and activated joint_state_broadcaster",
        "Loaded position_controller",
        "Configured and activated position_controller",
    ]


@pytest.mark.parametrize(
    ("flag", "state"), [("--load-only", "unconfigured"), ("--inactive", "inactive")]
)
def test_it_stops_where_told(control: Any, spawn: Any, flag: str, state: str) -> None:
    succeeded(spawn("position_controller", flag))
    assert control.states() == {"position_controller": state}


def test_a_group_is_activated_in_one_switch(control: Any, spawn: Any, manager: Any) -> None:
    succeeded(spawn("position_controller", "joint_state_broadcaster", "--activate-as-group"))
    manager.wait_for_line("Activated controllers: [ position_controller joint_state_broadcaster ]")


def test_a_group_is_all_or_nothing(control: Any, spawn: Any) -> None:
    output = failed(spawn("position_controller", "second_controller", "--activate-as-group"))
    assert "will be used by another controller that is being activated" in output
    assert "Failed to activate controller : position_controller second_controller" in output
    assert set(control.states().values()) == {"inactive"}


def test_a_loaded_controller_is_not_loaded_again(control: Any, spawn: Any) -> None:
    control.load("position_controller")
    spawner = spawn("position_controller")
    succeeded(spawner)
    assert "Controller already loaded, skipping load_controller" in spawner.output
    assert control.states() == {"position_controller": "active"}


def test_an_active_controller_cannot_be_spawned(control: Any, spawn: Any) -> None:
    control.start("position_controller")
    output = failed(spawn("position_controller"))
    assert "Failed to configure controller position_controller" in output
    assert "the reason is in the log of /controller_manager" in output


def test_a_failed_activation_ends_with_code_1_and_the_managers_word(
    control: Any, spawn: Any
) -> None:
    control.start("position_controller")
    output = failed(spawn("second_controller"))
    assert "'j3/position' is currently claimed by another controller." in output
    assert "Failed to activate controller : second_controller" in output
    assert control.states()["second_controller"] == "inactive"


def test_an_unknown_controller_ends_with_code_1(control: Any, spawn: Any) -> None:
    assert "Failed loading controller nothere" in failed(spawn("nothere"))


def test_without_a_name_it_ends_with_code_2(spawn: Any) -> None:
    assert "the following arguments are required: NAME" in failed(spawn(), 2)


def test_without_a_manager_it_gives_up_after_its_time(spawn: Any) -> None:
    output = failed(spawn("a", "-c", "/nobody", "--controller-manager-timeout", "0.3"))
    assert "Could not contact service /nobody/list_controllers within 0.3 s" in output


def test_it_waits_for_a_manager_that_comes_later(
    spawn: Any, run_manager: Any, control_of: Any
) -> None:
    spawner = spawn("jsb", "-c", "/late/controller_manager", "-p", "/dev/null")
    assert "holds no nodes" in failed(spawner)
    spawner = spawn("jsb", "-c", "/late/controller_manager")
    run_manager(
        parameters={"/late/controller_manager": {"ros__parameters": {"jsb.type": BROADCASTER}}},
        ros_arguments=("-r", "__ns:=/late"),
    )
    succeeded(spawner)
    assert control_of("/late").states() == {"jsb": "active"}


# Parameter files


def test_a_file_brings_type_and_parameters(control: Any, spawn: Any, file: Any) -> None:
    path = file({"fresh": {"ros__parameters": {"type": POSITION, "joints": ["j2"]}}})
    succeeded(spawn("fresh", "-p", path))
    (controller,) = control.list()
    assert (controller.type, controller.claimed_interfaces) == (POSITION, ["j2/position"])


@pytest.mark.parametrize("key", ["/**/fresh", "/**", "/fresh"])
def test_wildcards_serve(control: Any, spawn: Any, file: Any, key: str) -> None:
    path = file({key: {"ros__parameters": {"type": POSITION, "joints": ["j2"]}}})
    succeeded(spawn("fresh", "--inactive", "-p", path))
    assert control.list()[0].required_command_interfaces == ["j2/position"]


def test_of_several_files_the_last_wins(control: Any, spawn: Any, tmp_path: Path) -> None:
    arguments: list[str] = []
    for joint in ("j1", "j2"):
        path = tmp_path / f"{joint}.yaml"
        path.write_text(
            yaml.safe_dump({"fresh": {"ros__parameters": {"type": POSITION, "joints": [joint]}}})
        )
        arguments += ["-p", str(path)]
    succeeded(spawn("fresh", "--inactive", *arguments))
    assert control.list()[0].required_command_interfaces == ["j2/position"]


def test_a_missing_file_ends_with_a_sentence(control: Any, spawn: Any) -> None:
    output = failed(spawn("position_controller", "-p", "/no/such/file.yaml"))
    assert "cannot read parameter file '/no/such/file.yaml'" in output


def test_a_file_with_a_wrong_type_of_value_is_refused_by_the_manager(
    control: Any, spawn: Any, file: Any, manager: Any
) -> None:
    path = file({"fresh": {"ros__parameters": {"type": POSITION, "joints": "j2"}}})
    failed(spawn("fresh", "-p", path))
    manager.wait_for_line("parameter 'joints' must be a list, not 'j2'")
    assert control.states() == {}


def test_ros_arguments_reach_the_controllers_node(control: Any, spawn: Any, client: Any) -> None:
    arguments = "--controller-ros-args=-r ~/commands:=/elsewhere"
    succeeded(spawn("position_controller", arguments))
    client.wait_until(
        lambda: client.node.get_subscriptions_info_by_topic("/elsewhere"), "the remapped topic"
    )


# Namespaces


def test_the_manager_is_looked_for_in_the_own_namespace(
    spawn: Any, run_manager: Any, control_of: Any
) -> None:
    run_manager(
        parameters={"/near/controller_manager": {"ros__parameters": {"jsb.type": BROADCASTER}}},
        ros_arguments=("-r", "__ns:=/near"),
    )
    succeeded(spawn("jsb", "--ros-args", "-r", "__ns:=/near"))
    assert control_of("/near").states() == {"jsb": "active"}


# The end


@pytest.mark.parametrize("number", [signal.SIGINT, signal.SIGTERM])
def test_it_can_stay_and_unload_in_the_end(control: Any, spawn: Any, number: int) -> None:
    spawner = spawn("joint_state_broadcaster", "position_controller", "-u")
    spawner.wait_for_line("Configured and activated position_controller")
    assert spawner.process.poll() is None
    assert spawner.stop(number) == 0
    assert "Unloaded controller position_controller" in spawner.output
    assert control.states() == {}


def test_a_signal_ends_the_wait(spawn: Any) -> None:
    spawner = spawn("a", "-c", "/nobody")
    spawner.wait_for_line("waiting for service /nobody/list_controllers")
    assert spawner.stop(signal.SIGINT) == 0
    assert "Traceback" not in spawner.output
