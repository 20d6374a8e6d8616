"""The health of a controller manager, as rqt_robot_monitor and others read it."""

from collections.abc import Callable
from typing import Any

import pytest
from diagnostic_msgs.msg import DiagnosticArray
from rcl_interfaces.msg import LoggerLevel
from rcl_interfaces.srv import GetLoggerLevels, SetLoggerLevels

TASKS = ("Controllers Activity", "Hardware Components Activity", "Controller Manager Activity")
TIMES = "diagnostics.threshold.controllers.execution_time"
OK, WARN, ERROR = b"\x00", b"\x01", b"\x02"


@pytest.fixture(scope="module")
def manager(run_manager):
    """Return a manager that does not mind a busy computer, and reports ten times a second."""
    kinds, figures, levels = (
        ("controllers", "hardware_components"),
        ("mean_error", "standard_deviation"),
        ("warn", "error"),
    )
    patience = {
        f"diagnostics.threshold.{kind}.execution_time.{figure}.{level}": 1e9
        for kind in kinds
        for figure in figures
        for level in levels
    }
    position = {"type": "position_controllers/JointGroupPositionController"}
    return run_manager(
        parameters={
            "controller_manager": {
                "ros__parameters": {
                    "diagnostic_updater": {"period": 0.1},
                    **patience,
                    "position_controller": position,
                }
            },
            "position_controller": {"ros__parameters": {"joints": ["j0", "j1"]}},
        }
    )


@pytest.fixture
def wait_for_report(client) -> Callable[..., Any]:
    """Return a function that waits for a task's report of a kind."""
    collector = client.subscribe(DiagnosticArray, "/diagnostics")

    def wait(task: int, condition: Callable[[Any], object], what: str) -> Any:
        name = f"controller_manager: {TASKS[task]}"
        found: list[Any] = []

        def is_found(messages: list[Any]) -> bool:
            found[:] = [s for m in messages for s in m.status if s.name == name and condition(s)]
            return bool(found)

        collector.clear()
        collector.wait_until(is_found, f"report on {TASKS[task]}: {what}")
        return found[-1]

    return wait


def values_of(status: Any) -> dict[str, str]:
    return {item.key: item.value for item in status.values}


def test_it_is_published_by_the_manager_reliably(control, client):
    control.list()
    read = client.node.get_publishers_info_by_topic
    # The name of its node arrives later than the end point.
    client.wait_until(
        lambda: [e.node_name for e in read("/diagnostics")] == ["controller_manager"], "it"
    )
    (end_point,) = read("/diagnostics")
    assert end_point.topic_type == "diagnostic_msgs/msg/DiagnosticArray"
    assert end_point.qos_profile.reliability.name == "RELIABLE"
    assert end_point.qos_profile.durability.name == "VOLATILE"


def test_each_message_has_all_tasks_of_one_hardware_id(client, control):
    message = client.subscribe(DiagnosticArray, "/diagnostics").wait_for(1)[0]
    assert [s.name for s in message.status] == [f"controller_manager: {task}" for task in TASKS]
    assert {s.hardware_id for s in message.status} == {"ros2_control"}
    assert message.header.stamp.sec > 0


def test_it_follows_what_the_manager_does(control, wait_for_report):
    status = wait_for_report(0, lambda s: "No controllers" in s.message, "none loaded")
    assert (status.level, status.message) == (WARN, "No controllers are currently loaded")
    control.start("position_controller")
    status = wait_for_report(
        0, lambda s: "position_controller.execution_time" in values_of(s), "one that runs"
    )
    assert (status.level, status.message) == (OK, "All controllers are active")
    assert values_of(status)["position_controller.state"] == "active"
    status = wait_for_report(1, lambda s: True, "any")
    assert (status.level, status.message) == (OK, "All hardware components are active")
    assert values_of(status)["HardwareInterface.state"] == "active"
    status = wait_for_report(2, lambda s: "periodicity.average" in values_of(s), "with a rate")
    assert float(values_of(status)["periodicity.average"]) == pytest.approx(100.0, rel=1e-3)


def test_why_a_request_was_refused_can_be_read(control, wait_for_report):
    assert not control.load("nothere")
    assert not control.switch(["nothere"]).ok
    status = wait_for_report(0, lambda s: "switch_controller" in values_of(s), "a refusal")
    values = values_of(status)
    assert values["nothere.load_controller"].startswith(
        "The 'type' param was not defined for 'nothere'."
    )
    assert "no controller with this name exists" in values["switch_controller"]
    control.start("position_controller")
    status = wait_for_report(0, lambda s: "switch_controller" not in values_of(s), "no refusal")
    assert "nothere.load_controller" in values_of(status)


def test_changed_thresholds_take_effect_immediately(control, wait_for_report, set_parameter):
    control.start("position_controller")
    wait_for_report(0, lambda s: s.level == OK, "nothing wrong")
    name = f"{TIMES}.mean_error.error"
    refused = set_parameter("/controller_manager", name, -1.0)
    assert (refused.successful, refused.reason) == (
        False,
        f"parameter '{name}' must be above 0, but is -1.0",
    )
    assert set_parameter("/controller_manager", name, 0.001).successful
    status = wait_for_report(0, lambda s: s.level == ERROR, "an error")
    assert status.message == "Controllers with high execution time : [ position_controller ]"
    assert set_parameter("/controller_manager", name, 1e9).successful
    wait_for_report(0, lambda s: s.level == OK, "nothing wrong")


def test_a_stuck_loop_is_reported_while_it_is_stuck(manager, wait_for_report):
    manager.tell("block")
    try:
        status = wait_for_report(2, lambda s: "stuck" in s.message, "a stuck loop")
    finally:
        manager.tell("unblock")
    assert status.level == ERROR
    wait_for_report(2, lambda s: "stuck" not in s.message, "a loop that goes on")


@pytest.mark.parametrize(
    ("node", "name"),
    [
        ("controller_manager", "controller_manager"),
        ("position_controller", "position_controller"),
        ("hardwareinterface", "hardwareinterface"),
    ],
)
def test_the_level_of_a_logger_can_be_read_and_set(client, control, node, name):
    assert control.load("position_controller")
    set_levels = f"/{node}/set_logger_levels"
    request = SetLoggerLevels.Request(
        levels=[LoggerLevel(name=name, level=LoggerLevel.LOG_LEVEL_FATAL)]
    )
    (result,) = client.call(SetLoggerLevels, set_levels, request).results
    assert result.successful
    answer = client.call(
        GetLoggerLevels, f"/{node}/get_logger_levels", GetLoggerLevels.Request(names=[name])
    )
    assert answer.levels[0].level == LoggerLevel.LOG_LEVEL_FATAL
    request.levels[0].level = LoggerLevel.LOG_LEVEL_INFO
    assert client.call(SetLoggerLevels, set_levels, request).results[0].successful


def test_a_manager_without_a_robot_says_what_it_waits_for(run, client):
    program = run(
        "-m",
        "arm_control.manager.ros2_control_node",
        "--ros-args",
        *("-r", "__ns:=/waiting"),
        *("-p", "diagnostic_updater.period:=0.1"),
        *("-p", "diagnostic_updater.use_fqn:=true"),
    )
    prefix = "/waiting/controller_manager: "
    messages = client.subscribe(DiagnosticArray, "/diagnostics").wait_until(
        lambda messages: any(m.status[0].name.startswith(prefix) for m in messages),
        "a report of the waiting manager",
    )
    statuses = [s for m in messages for s in m.status if s.name.startswith(prefix)]
    assert {s.name for s in statuses} == {prefix + task for task in TASKS}
    assert {(s.level, s.message) for s in statuses} == {(WARN, "Waiting for robot description....")}
    assert program.stop() == 0
    assert "Traceback" not in program.output
