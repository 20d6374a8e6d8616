"""Trajectories of the simulated arm at half the speed of real time."""

from collections.abc import Callable
from itertools import pairwise
from typing import Any

import pytest

pytestmark = pytest.mark.ros

HOME = (0.0, 0.0, 0.0, 0.0)
THERE = (0.4, 0.3, 0.2, 0.3)
REACHED = (4, 0, "Goal successfully reached!")
CANCELED = 5
CYCLE_S = 0.002
DECELERATION = 1.0
"""constraints.<joint>.max_deceleration_on_cancel."""


def seconds(time: Any) -> float:
    return time.sec + time.nanosec * 1e-9


@pytest.fixture(scope="module")
def manager(simulate: Callable[[float], Any]) -> Any:
    return simulate(0.5)


@pytest.fixture
def send(control: Any, sender_to: Callable[[str], Any]) -> Any:
    control.start("position_commands")
    return sender_to("position_commands")


@pytest.fixture
def states(client: Any) -> Any:
    from control_msgs.msg import JointTrajectoryControllerState

    return client.subscribe(
        JointTrajectoryControllerState, "/position_commands/controller_state", 100
    )


def test_a_goal_ends_after_its_time(send: Any, states: Any) -> None:
    assert send((0.5, THERE)).result() == REACHED
    arrived = states.wait_until(
        lambda messages: (
            messages and list(messages[-1].feedback.positions) == pytest.approx(THERE, abs=0.01)
        ),
        "the arm is there",
    )[-1]
    assert seconds(arrived.reference.time_from_start) >= 0.45


def test_a_cancelled_goal_brakes_with_the_given_deceleration(send: Any, states: Any) -> None:
    send((1.0, HOME)).result()
    goal = send((1000.0, (500.0, 0.0, 0.0, 0.0)))
    # It brakes from the measured velocity, which swings for some cycles after the sudden start.
    states.wait_until(
        lambda m: m and m[-1].feedback.positions[0] > 0.1 and m[-1].reference.velocities[0] > 0.0,
        "it moves steadily",
    )
    assert goal.cancel() == 1
    assert goal.result() == (CANCELED, 0, "")
    messages = states.wait_until(
        lambda m: m and m[-1].reference.velocities[0] == 0.0 < m[-1].reference.positions[0],
        "it stands",
    )
    braking = [m.reference for m in messages if m.reference.accelerations[0] < 0.0]
    assert {reference.accelerations[0] for reference in braking} == {-DECELERATION}
    first, last = braking[0], messages[-1].reference
    speed = first.velocities[0]
    assert speed == pytest.approx(0.5, abs=0.1)
    way = last.positions[0] - first.positions[0]
    assert way == pytest.approx(speed**2 / (2 * DECELERATION), abs=0.02)
    for before, after in pairwise(braking):
        assert after.velocities[0] <= before.velocities[0]


def test_a_scaled_speed_takes_longer_and_is_reported(send: Any, states: Any, client: Any) -> None:
    from control_msgs.msg import SpeedScalingFactor
    from rclpy.qos import DurabilityPolicy, QoSProfile

    latched = QoSProfile(depth=1, durability=DurabilityPolicy.TRANSIENT_LOCAL)
    topic = "/position_commands/speed_scaling_input"
    publisher = client.publisher(SpeedScalingFactor, topic, latched)
    publisher.publish(SpeedScalingFactor(factor=0.5))
    states.wait_until(lambda m: m and m[-1].speed_scaling_factor == 0.5, "half the speed")
    goal = send((0.5, THERE))
    assert goal.result() == REACHED
    last = goal.feedback.wait_until(
        lambda m: m and seconds(m[-1].desired.time_from_start) > 0.449, "the last feedback"
    )[-1]
    assert seconds(last.desired.time_from_start) == pytest.approx(0.475, abs=0.026)
    assert seconds(last.actual.time_from_start) == pytest.approx(
        2 * seconds(last.desired.time_from_start), abs=2 * CYCLE_S
    )


def test_a_partial_goal_holds_the_other_joints(send: Any, states: Any) -> None:
    assert send((0.3, THERE)).result() == REACHED
    assert send((0.3, (-0.2,)), joints=["j2"]).result() == REACHED
    expected = [THERE[0], THERE[1], -0.2, THERE[3]]
    states.wait_until(
        lambda m: m and list(m[-1].feedback.positions) == pytest.approx(expected, abs=0.01),
        "j2 alone has moved",
    )


def test_a_trajectory_that_is_over_is_held_after_the_time_out(
    send: Any, client: Any, trajectory: Any, set_parameter: Any, manager: Any
) -> None:
    from trajectory_msgs.msg import JointTrajectory

    goal_time = set_parameter("/position_commands", "constraints.goal_time", 0.1)
    assert goal_time.successful
    assert set_parameter("/position_commands", "cmd_timeout", 0.2).successful
    publisher = client.publisher(JointTrajectory, "/position_commands/joint_trajectory")
    publisher.publish(trajectory((0.2, HOME)))
    manager.wait_for_line("Aborted due to command timeout")
