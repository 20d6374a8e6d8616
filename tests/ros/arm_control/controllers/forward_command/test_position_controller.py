"""/position_controller/commands, from a client's message to /joint_states."""

from collections.abc import Callable
from typing import Any

import pytest
from rclpy.qos import qos_profile_sensor_data
from sensor_msgs.msg import JointState
from std_msgs.msg import Float64MultiArray

COMMANDS = "/position_controller/commands"


@pytest.fixture
def publish(client) -> Callable[..., None]:
    """Return a function that publishes one command."""
    publishers: list[Any] = []

    def send(*data: float) -> None:
        if not publishers:
            publishers.append(client.publisher(Float64MultiArray, COMMANDS))
        publishers[0].publish(Float64MultiArray(data=list(data)))

    return send


@pytest.fixture
def positions(control, client):
    """Start both controllers; return what is published as joint states."""
    control.start("joint_state_broadcaster", "position_controller")
    states = client.subscribe(JointState, "/joint_states")
    states.wait_for(1)
    return states


def wait_for(positions: Any, *expected: float) -> Any:
    """Wait until these positions are published; return their message."""
    messages = positions.wait_until(
        lambda messages: list(messages[-1].position) == list(expected), f"position {expected}"
    )
    return messages[-1]


def test_a_command_shows_in_the_joint_states(positions, publish):
    publish(0.1, 0.2, 0.3, 0.4)
    assert wait_for(positions, 0.1, 0.2, 0.3, 0.4).name == ["j0", "j1", "j2", "j3"]


def test_messages_of_a_best_effort_publisher_arrive(positions, client):
    publisher = client.publisher(Float64MultiArray, COMMANDS, qos_profile_sensor_data)
    publisher.publish(Float64MultiArray(data=[0.5, 0.0, 0.0, 0.0]))
    assert wait_for(positions, 0.5, 0.0, 0.0, 0.0).name == ["j0", "j1", "j2", "j3"]


def test_a_wrong_length_deactivates_it_and_the_log_says_how_to_go_on(
    control, positions, publish, manager
):
    publish(0.1, 0.2)
    manager.wait_for_line("command size (2) does not match number of interfaces (4)")
    manager.wait_for_line(
        "Deactivating controllers : [ position_controller ] as their update resulted in an error!"
    )
    manager.wait_for_line(
        "activate again with: arm control switch_controllers --activate position_controller"
    )
    control.wait_for_states(position_controller="inactive", joint_state_broadcaster="active")
    # Later commands vanish, and that is said once, by the time the next line is logged.
    for _ in range(3):
        publish(0.3, 0.0, 0.0, 0.0)
    said = "commands on /position_controller/commands have no effect: the controller is not active"
    manager.wait_for_line(
        f"{said}; activate it with: arm control switch_controllers --activate position_controller"
    )
    assert control.switch(["position_controller"]).ok
    publish(0.7, 0.0, 0.0, 0.0)
    wait_for(positions, 0.7, 0.0, 0.0, 0.0)
    assert sum(said in line for line in manager.lines) == 1
