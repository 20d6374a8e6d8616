"""Parameters of the manager and its controllers."""

from collections.abc import Callable
from typing import Any

import pytest
from rcl_interfaces.srv import DescribeParameters, GetParameters, ListParameters
from rclpy.parameter import parameter_value_to_python

POSITION = "position_controllers/JointGroupPositionController"
BROADCASTER = "joint_state_broadcaster/JointStateBroadcaster"
JOINTS = ("j0", "j1", "j2", "j3")


@pytest.fixture
def parameters_of(client) -> Callable[[str], dict[str, Any]]:
    """Return a function that reads all parameters of a node."""

    def read(node: str) -> dict[str, Any]:
        names = client.call(
            ListParameters, f"{node}/list_parameters", ListParameters.Request()
        ).result.names
        values = client.call(
            GetParameters, f"{node}/get_parameters", GetParameters.Request(names=names)
        ).values
        return {
            name: parameter_value_to_python(value)
            for name, value in zip(names, values, strict=True)
        }

    return read


THRESHOLDS = {
    "controller_manager": ("periodicity",),
    "controllers": ("periodicity", "execution_time"),
    "hardware_components": ("periodicity", "execution_time"),
}
FIGURES = {
    ("periodicity", "mean_error"): (5.0, 10.0),
    ("periodicity", "standard_deviation"): (5.0, 10.0),
    ("execution_time", "mean_error"): (1000.0, 2000.0),
    ("execution_time", "standard_deviation"): (100.0, 200.0),
}
READ_ONLY = {
    "defaults.allow_controller_activation_with_inactive_hardware": False,
    "defaults.deactivate_controllers_on_hardware_self_deactivate": True,
    "enforce_command_limits": False,
    "handle_exceptions": True,
    "hardware_components_initial_state.shutdown_on_initial_state_failure": True,
    "update_rate": 100,
}


def threshold_parameters() -> dict[str, float]:
    """Return the thresholds of ros2_control by name."""
    return {
        f"diagnostics.threshold.{owner}.{quantity}.{figure}.{level}": value
        for owner, quantities in THRESHOLDS.items()
        for (quantity, figure), values in FIGURES.items()
        for level, value in zip(("warn", "error"), values, strict=True)
        if quantity in quantities
    }


def test_the_managers_parameters(control, parameters_of, client):
    control.load("position_controller")
    parameters = parameters_of("/controller_manager")
    expected = {
        "defaults.switch_controller.strictness": "best_effort",
        "hardware_components_initial_state.inactive": [],
        "hardware_components_initial_state.unconfigured": [],
        "overruns.print_warnings": True,
        "diagnostic_updater.period": 1.0,
        "diagnostic_updater.use_fqn": False,
        "position_controller.type": POSITION,
        "position_controller.fallback_controllers": [],
        "position_controller.node_options_args": [],
        **threshold_parameters(),
        **READ_ONLY,
    }
    assert {name: parameters[name] for name in expected} == expected
    descriptions = client.call(
        DescribeParameters,
        "/controller_manager/describe_parameters",
        DescribeParameters.Request(names=list(expected)),
    ).descriptors
    assert {d.name for d in descriptions if d.read_only} == set(READ_ONLY)
    assert all(d.description for d in descriptions)


def test_a_controllers_parameters(control, parameters_of):
    control.load("position_controller")
    parameters = parameters_of("/position_controller")
    expected = {
        "interface_name": "position",
        "is_async": False,
        "joints": list(JOINTS),
        "thread_priority": -100,
        "update_rate": 100,
    }
    assert {name: parameters[name] for name in expected} == expected


def test_a_controller_with_is_async_gets_a_warning(control, manager, set_parameter):
    control.load("position_controller")
    assert set_parameter("/position_controller", "is_async", True).successful
    assert control.configure("position_controller")
    manager.wait_for_line("parameter 'is_async' has no effect: controllers run in the control loop")
    assert [c.is_async for c in control.list()] == [False]


def test_the_broadcasters_parameters_are_read_only(control, parameters_of, set_parameter):
    control.load("joint_state_broadcaster")
    parameters = parameters_of("/joint_state_broadcaster")
    expected = {
        "extra_joints": [],
        "frame_id": "base_link",
        "interfaces": [],
        "joints": [],
        "map_interface_to_joint_state.effort": "effort",
        "map_interface_to_joint_state.position": "position",
        "map_interface_to_joint_state.velocity": "velocity",
        "publish_dynamic_joint_states": True,
        "use_local_topics": False,
        "use_urdf_to_filter": True,
    }
    assert {name: parameters[name] for name in expected} == expected
    for name, value in (("frame_id", "other"), ("joints", ["j0"])):
        result = set_parameter("/joint_state_broadcaster", name, value)
        assert not result.successful
        assert "read-only" in result.reason


def test_parameters_that_mean_nothing_are_reported(run_manager):
    program = run_manager(
        "--start",
        "position_controller",
        parameters={
            # These mean something to the manager, whose process the controllers share.
            "/**": {
                "ros__parameters": {
                    "enforce_command_limits": False,
                    "robot_description": "<robot name='r'/>",
                    "another.type": BROADCASTER,
                }
            },
            "/**/controller_manager": {
                "ros__parameters": {
                    "position_controller.type": POSITION,
                    "updaterate": 5,
                    "hardware_component_initial_state": {"inactive": ["Arm"]},
                }
            },
            "/**/position_controller": {
                "ros__parameters": {"joints": ["j0"], "state_publish_rate": 100.0, "open": True}
            },
        },
        ros_arguments=("-r", "__ns:=/reports"),
    )
    line = program.wait_for_line(f"is not known to {POSITION}")
    assert f"parameter 'open', 'state_publish_rate' is not known to {POSITION}" in line
    assert "known: command_timeout, interface_name, is_async, joints" in line
    own = "is not known to controller_manager and has no effect; did you mean"
    for given, meant in (
        ("updaterate", "update_rate"),
        ("hardware_component_initial_state.inactive", "hardware_components_initial_state.inactive"),
    ):
        program.wait_for_line(f"parameter '{given}' {own} '{meant}'?")
    assert program.output.count(own) == 2


def test_an_integer_serves_and_an_empty_list_does_no_harm(run_manager):
    manager = run_manager(
        "--start",
        "jsb",
        parameters={
            "/**/controller_manager": {
                "ros__parameters": {
                    "jsb": {"type": BROADCASTER, "fallback_controllers": []},
                    "hardware_components_initial_state": {"inactive": []},
                    # For real-time kernels and hardware: accepted, as by a real one.
                    "lock_memory": True,
                    "thread_priority": 50,
                    "cpu_affinity": [0, 1],
                    "overruns": {"manage": True},
                }
            },
            "/**/jsb": {"ros__parameters": {"joints": []}},
        },
        ros_arguments=("-r", "__ns:=/empty"),
    )
    assert "ERROR" not in manager.output


@pytest.mark.parametrize(
    ("parameters", "reason"),
    [
        ({"update_rate": 0}, "parameter 'update_rate' must be above 0, but is 0"),
        ({"update_rate": "fast"}, "parameter 'update_rate' must be of type int, not 'fast'"),
        (
            {"diagnostics.threshold.controllers.execution_time.mean_error.warn": 0.0},
            "execution_time.mean_error.warn' must be above 0, but is 0.0",
        ),
        (
            {"defaults": {"switch_controller": {"strictness": "lax"}}},
            "must be one of best_effort, strict, but is 'lax'",
        ),
    ],
)
def test_parameters_of_the_manager_that_make_no_sense_end_it_with_a_sentence(
    run_manager, parameters, reason
):
    program = run_manager(
        parameters={"/**/controller_manager": {"ros__parameters": parameters}},
        ros_arguments=("-r", "__ns:=/refused"),
        wait=False,
    )
    assert program.wait() == 1
    assert reason in program.output
    assert "Traceback" not in program.output


def test_a_controller_with_a_name_of_300_characters_is_refused(control):
    assert not control.load("a" * 300)
    assert control.states() == {}
