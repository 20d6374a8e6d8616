"""Trajectories of the simulated arm, by every kind of command, as fast as they can be simulated."""

from collections.abc import Callable
from typing import Any

import pytest

pytestmark = pytest.mark.ros

STILL = (0.0, 0.0, 0.0, 0.0)
HOME = (0.0, 0.0, 0.0, 0.0)
THERE = (0.4, 0.3, 0.2, 0.3)
REACHED = (4, 0, "Goal successfully reached!")
COMMANDS = (
    "position_commands",
    "velocity_commands",
    "effort_commands",
    "position_and_effort_commands",
)


def seconds(time: Any) -> float:
    return time.sec + time.nanosec * 1e-9


@pytest.fixture(scope="module")
def manager(simulate: Callable[[float], Any]) -> Any:
    return simulate(0.0)


@pytest.fixture
def measured(client: Any) -> Callable[[str], list[float]]:
    """Return a function that asks a controller where the joints are."""
    from control_msgs.srv import QueryTrajectoryState

    def ask(name: str) -> list[float]:
        service = f"/{name}/query_state"
        # There is no trajectory at time 0, and the answer then tells where the joints are.
        answer = client.call(QueryTrajectoryState, service, QueryTrajectoryState.Request())
        return list(answer.position)

    return ask


@pytest.mark.parametrize("name", COMMANDS)
def test_a_goal_is_reached(
    control: Any,
    sender_to: Callable[[str], Any],
    measured: Callable[[str], list[float]],
    name: str,
) -> None:
    control.start(name)
    send = sender_to(name)
    for target in (THERE, HOME):
        assert send((1.0, target, STILL, STILL)).result() == REACHED
        assert measured(name) == pytest.approx(list(target), abs=0.05)


def test_feedback_follows_simulation_time(control: Any, sender_to: Callable[[str], Any]) -> None:
    control.start("position_commands")
    goal = sender_to("position_commands")((1.0, THERE), (10.0, HOME))
    assert goal.result() == REACHED
    messages = goal.feedback.messages
    ages = [seconds(m.header.stamp) - seconds(m.desired.time_from_start) for m in messages]
    assert ages == pytest.approx([ages[0]] * len(ages), abs=1e-6)
    assert seconds(messages[-1].desired.time_from_start) <= 10.0 + 1e-6
