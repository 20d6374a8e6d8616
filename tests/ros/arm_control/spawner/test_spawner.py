"""The spawner as a program: its work, its output, its exit codes."""

import fcntl
import signal
import threading
from collections.abc import Iterator
from pathlib import Path
from typing import Any

import pytest
from controller_manager_msgs.msg import ControllerState
from controller_manager_msgs.srv import ConfigureController, ListControllers

BROADCASTER = "joint_state_broadcaster/JointStateBroadcaster"


def test_it_loads_configures_and_activates_in_order(control, spawn):
    spawner = spawn("joint_state_broadcaster", "position_controller")
    spawner.succeed()
    assert control.states() == {
        "position_controller": "active",
        "joint_state_broadcaster": "active",
    }
    lines = [line.split("]: ")[-1] for line in spawner.own_words]
    # It says so where it has to wait for the manager or to ask it again.
    waits = ("waiting for service ", "no answer from ")
    assert [line for line in lines if not line.startswith(waits)] == [
        "Loaded joint_state_broadcaster",
        "Configured and activated joint_state_broadcaster",
        "Loaded position_controller",
        "Configured and activated position_controller",
    ]


@pytest.mark.parametrize(
    ("flag", "state"), [("--load-only", "unconfigured"), ("--inactive", "inactive")]
)
def test_it_stops_at_the_requested_state(control, spawn, flag, state):
    spawn("position_controller", flag).succeed()
    assert control.states() == {"position_controller": state}


def test_what_is_loaded_or_configured_can_be_spawned_and_what_is_active_cannot(control, spawn):
    control.load("position_controller")
    output = spawn("position_controller", "--no-switch-asap").succeed()
    assert "Controller already loaded, skipping load_controller" in output
    assert control.states() == {"position_controller": "active"}
    # The first cannot be configured, so the others are left alone.
    output = spawn("position_controller", "second_controller").fail()
    assert "Failed to configure controller position_controller" in output
    assert "the reason is in the log of /controller_manager" in output
    assert control.states() == {"position_controller": "active"}
    assert control.switch((), ["position_controller"]).ok
    spawn("position_controller").succeed()
    assert control.states() == {"position_controller": "active"}


def test_a_group_is_activated_in_one_switch(control, spawn, manager):
    names = ("position_controller", "joint_state_broadcaster")
    output = spawn(*names, "--activate-as-group").succeed()
    assert f"Configured and activated all the parsed controllers list : {list(names)}!" in output
    manager.wait_for_line("Activated controllers: [ position_controller joint_state_broadcaster ]")


def test_a_group_is_all_or_nothing(control, spawn):
    output = spawn("position_controller", "second_controller", "--activate-as-group").fail()
    assert "will be used by another controller that is being activated" in output
    assert "Failed to activate controller : position_controller second_controller" in output
    assert set(control.states().values()) == {"inactive"}


def test_a_failed_activation_exits_with_code_1_and_the_managers_message(control, spawn, unspawn):
    control.start("position_controller")
    output = spawn("second_controller").fail()
    assert "'j3/position' is currently claimed by another controller." in output
    assert "Failed to activate controller : second_controller" in output
    assert control.states()["second_controller"] == "inactive"
    unspawn("position_controller").succeed()
    spawn("second_controller").succeed()
    assert control.states() == {"second_controller": "active"}


def test_an_unknown_controller_ends_with_code_1(control, spawn):
    assert "Failed loading controller not-there" in spawn("not-there").fail()
    assert control.states() == {}


def test_without_a_manager_it_gives_up_after_its_time(spawn):
    output = spawn("a", "-c", "/nobody", "--controller-manager-timeout", "0.3").fail()
    assert "Could not contact service /nobody/list_controllers within 0.3 s" in output


def test_it_waits_for_a_manager_that_comes_later(spawn, run_manager, control_of):
    spawner = spawn("jsb", "--ros-args", "-r", "__ns:=/late")
    spawner.wait_for_line("waiting for service /late/controller_manager/list_controllers")
    run_manager(
        parameters={"/late/controller_manager": {"ros__parameters": {"jsb.type": BROADCASTER}}},
        ros_arguments=("-r", "__ns:=/late"),
    )
    spawner.succeed()
    assert control_of("/late").states() == {"jsb": "active"}
    output = spawn("jsb", "-n", "late", "--ros-args", "-r", "__ns:=/late").fail()
    assert "the namespace is given twice, by --namespace late and by __ns:=/late" in output
    output = spawn("jsb", "-n", "late", "-c", "controller_manager").fail()
    assert "--namespace is deprecated; write --ros-args -r __ns:=/late" in output
    assert "Failed to configure controller jsb" in output


# An answer that does not come


class SlowManager:
    """A manager with one controller that configures it, but answers only when it is let."""

    def __init__(self, client: Any) -> None:
        self.state = "unconfigured"
        self.configurations = 0
        self.may_answer = threading.Event()
        for service, type_, serve in (
            ("list_controllers", ListControllers, self._list),
            ("configure_controller", ConfigureController, self._configure),
        ):
            client.node.create_service(type_, f"/slow/controller_manager/{service}", serve)

    def _list(self, _: Any, answer: Any) -> Any:
        answer.controller = [ControllerState(name="a", state=self.state)]
        return answer

    def _configure(self, _: Any, answer: Any) -> Any:
        self.configurations += 1
        self.may_answer.wait(60.0)
        self.state = "inactive"
        answer.ok = True
        return answer


def test_a_step_without_an_answer_is_looked_up_and_not_done_twice(client, spawn):
    slow = SlowManager(client)
    manager = "/slow/controller_manager"
    spawner = spawn("a", "-c", manager, "--inactive", "--service-call-timeout", "2")
    spawner.wait_for_line(f"no answer from {manager}/configure_controller within 2 s")
    slow.may_answer.set()
    spawner.succeed()
    assert (slow.state, slow.configurations) == ("inactive", 1)


def test_a_manager_that_loads_nothing_is_given_up(control, manager, spawn):
    manager.tell("block")
    spawner = spawn("position_controller", "--service-call-timeout", "1")
    try:
        said = "/controller_manager/load_controller did not answer 3 times within 1 s each"
        assert said in spawner.fail()
    finally:
        manager.tell("unblock")
    # What it asked for last, the load, may have been done once the loop went on; no more than that.
    assert control.states() in ({}, {"position_controller": "unconfigured"})


# The end


@pytest.mark.parametrize("number", [signal.SIGINT, signal.SIGTERM])
def test_it_can_stay_and_unload_in_the_end(control, spawn, number):
    group = ["--activate-as-group"] if number == signal.SIGINT else []
    spawner = spawn("joint_state_broadcaster", "position_controller", "-u", *group)
    spawner.wait_for_line("Waiting until interrupt to unload controllers")
    assert set(control.states().values()) == {"active"}
    assert spawner.stop(number) == 0
    assert "Unloaded controller position_controller" in spawner.output
    assert control.states() == {}


def test_a_signal_ends_the_wait(spawn):
    spawner = spawn("a", "-c", "/nobody")
    spawner.wait_for_line("waiting for service /nobody/list_controllers")
    assert spawner.stop(signal.SIGINT) == 0
    assert "Traceback" not in spawner.output


# The lock


@pytest.fixture
def other_spawner(tmp_path_factory) -> Iterator[Any]:
    """Hold the lock as another spawner of this machine; closing the file releases it."""
    path = tmp_path_factory.getbasetemp() / "locks" / "ros2-control-controller-spawner.lock"
    path.parent.mkdir(exist_ok=True)
    with Path(path).open("w") as file:
        fcntl.flock(file, fcntl.LOCK_EX)
        yield file


def test_it_waits_for_another_spawner(control, spawn, other_spawner):
    spawner = spawn("position_controller")
    spawner.wait_for_line("waiting for another spawner, which holds")
    assert control.states() == {}
    assert spawner.process.poll() is None
    other_spawner.close()
    spawner.succeed()
    assert control.states() == {"position_controller": "active"}
