"""Failing controllers and hardware from the clients' view."""

from collections.abc import Callable, Iterator
from pathlib import Path
from typing import Any

import pytest
from controller_manager_msgs.msg import ControllerManagerActivity
from diagnostic_msgs.msg import DiagnosticArray
from rclpy.qos import DurabilityPolicy, QoSProfile

FAULTY = "test_faults/FaultyController"
PARAMETERS = {
    "/**/controller_manager": {
        "ros__parameters": {
            "diagnostic_updater.period": 0.1,
            "faulty": {"type": FAULTY, "fallback_controllers": ["spare"]},
            "spare": {"type": "position_controllers/JointGroupPositionController"},
            "bystander": {"type": FAULTY},
        }
    },
    "/**/faulty": {"ros__parameters": {"joints": ["j0", "j1"]}},
    "/**/spare": {"ros__parameters": {"joints": ["j0", "j1", "j2"]}},
    "/**/bystander": {"ros__parameters": {"joints": ["j2", "j3"]}},
}


@pytest.fixture(scope="module")
def faulty_package(tmp_path_factory) -> Iterator[None]:
    """Offer the faulty controller as an installed package does."""
    place = tmp_path_factory.mktemp("site")
    information = place / "test_faults-1.0.dist-info"
    information.mkdir()
    (information / "METADATA").write_text("Metadata-Version: 2.1\nName: test_faults\nVersion: 1.0")
    (information / "entry_points.txt").write_text(
        f"[arm_control.controllers]\n{FAULTY} = faulty_controller:FaultyController\n"
    )
    with pytest.MonkeyPatch.context() as patch:
        patch.setenv("PYTHONPATH", f"{place}:{Path(__file__).parent}")
        yield


@pytest.fixture(scope="module")
def manager(run_manager, faulty_package):
    """Return the module's manager, which knows the faulty controller."""
    return run_manager(parameters=PARAMETERS)


@pytest.fixture
def fail(set_parameter) -> Callable[[str], None]:
    """Return a function that makes the faulty controller fail."""

    def set_fault(fault: str) -> None:
        assert set_parameter("/faulty", "fault", fault).successful

    return set_fault


@pytest.fixture
def reports(client):
    """Return what is published on /diagnostics."""
    return client.subscribe(DiagnosticArray, "/diagnostics")


def activity(client: Any) -> Any:
    return client.subscribe(
        ControllerManagerActivity,
        "/controller_manager/activity",
        QoSProfile(depth=50, durability=DurabilityPolicy.TRANSIENT_LOCAL),
    )


@pytest.mark.parametrize("fault", ["raise", "error"])
def test_a_failing_controller_is_replaced_by_its_fallback(control, client, manager, fail, fault):
    for name in ("spare", "faulty", "bystander"):
        assert control.load(name)
        assert control.configure(name)
    assert control.switch(["faulty", "bystander"]).ok
    seen = activity(client)
    fail(fault)
    # The fallback needs j2 as well, so the controller that claims it must stop.
    control.wait_for_states(faulty="inactive", spare="active", bystander="inactive")
    manager.wait_for_line("Deactivating controllers : [ faulty ]")
    expected = {"faulty": "inactive", "spare": "active", "bystander": "inactive"}
    seen.wait_until(
        lambda messages: (
            messages and {c.name: c.state.label for c in messages[-1].controllers} == expected
        ),
        "activity after the failure",
    )


def test_a_blocking_controller_overruns_and_services_still_answer(control, manager, fail, reports):
    assert control.load("spare")
    assert control.configure("spare")
    control.start("faulty")
    fail("block")
    assert control.states() == {"faulty": "active", "spare": "inactive"}
    assert control.load("bystander")
    manager.wait_for_line("the control loop cannot keep its pace")
    reports.wait_until(
        lambda messages: any(
            "cannot keep its pace" in status.message
            or "Controllers with high execution time : [ faulty ]" in status.message
            for message in messages
            for status in message.status
        ),
        "a report of the overruns",
    )
    # It can be stopped although it blocks: a switch needs no more than the end of a cycle.
    assert control.switch([], ["faulty"]).ok


def test_a_switch_to_a_controller_that_starts_slowly_is_answered_with_what_came_of_it(
    control, set_parameter
):
    assert control.load("bystander")
    assert set_parameter("/bystander", "fault", "start slowly").successful
    assert control.configure("bystander")
    answer = control.switch(["bystander"], timeout_s=0)  # The manager's own.
    assert (answer.ok, answer.message) == (True, "Successfully switched controllers!")
    assert control.states() == {"bystander": "active"}


@pytest.mark.parametrize(
    ("order", "hardware", "line"),
    [
        ("fail read", "unconfigured", "their read cycle resulted in an error"),
        ("fail write", "unconfigured", "their write cycle resulted in an error"),
        ("deactivate", "inactive", "deactivates itself"),
    ],
)
def test_failing_hardware_stops_its_controllers_and_comes_back(
    control, client, manager, order, hardware, line
):
    control.start("bystander")
    seen = activity(client)
    manager.tell(order)
    control.wait_for_states(bystander="inactive")
    manager.wait_for_line(line)
    seen.wait_until(
        lambda messages: (
            messages and [c.state.label for c in messages[-1].hardware_components] == [hardware]
        ),
        f"activity with the component {hardware}",
    )
    manager.tell("recover")
    from lifecycle_msgs.msg import State

    answer = control.call(
        "set_hardware_component_state", name="HardwareInterface", target_state=State(label="active")
    )
    assert (answer.ok, answer.state.label) == (True, "active")
    assert control.switch(["bystander"]).ok


def test_without_handling_of_exceptions_the_process_ends_with_a_sentence(
    run_manager, faulty_package
):
    program = run_manager(
        "--start",
        "faulty",
        parameters={
            "/**/controller_manager": {
                "ros__parameters": {"handle_exceptions": False, "faulty.type": FAULTY}
            },
            "/**/faulty": {"ros__parameters": {"joints": ["j0"], "fault": "raise"}},
        },
        ros_arguments=("-r", "__ns:=/unhandled"),
        wait=False,
    )
    assert program.wait() == 1
    assert (
        "controller 'faulty' raised in its update: RuntimeError: out of order; "
        "the process ends, because parameter 'handle_exceptions' is false"
    ) in program.output
