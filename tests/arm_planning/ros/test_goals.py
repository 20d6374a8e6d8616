"""Goals of actions: their turns, and an end for each, whatever happens."""

from collections.abc import Callable
from types import SimpleNamespace
from typing import Any

import pytest
from moveit_msgs.action import MoveGroup

from arm_planning.errors import MoveItErrorCode
from arm_planning.ros import goals
from arm_planning.ros.goals import GoalServer, ServedGoal, Turns
from arm_planning.ros.trajectory_executor import ExecutionOutcome

DONE = ExecutionOutcome(MoveItErrorCode.SUCCESS)


class FakeHandle:
    """rclpy's side of a goal: it notes when it begins and how it ends."""

    def __init__(self, number: int) -> None:
        self.goal_id = SimpleNamespace(uuid=[number] * 16)
        self.request = MoveGroup.Goal()
        self.is_active = True
        self.is_cancel_requested = False
        self.begun = 0
        self.status = ""
        self.states: list[str] = []

    def execute(self) -> None:
        self.begun += 1

    def publish_feedback(self, feedback: Any) -> None:
        self.states.append(feedback.state)

    def _end(self, status: str) -> None:
        self.is_active, self.status = False, status

    def succeed(self) -> None:
        self._end("succeeded")

    def abort(self) -> None:
        self._end("aborted")

    def canceled(self) -> None:
        self._end("canceled")


class Server:
    """A GoalServer, and what rclpy calls of it."""

    def __init__(self, monkeypatch: pytest.MonkeyPatch) -> None:
        monkeypatch.setattr(goals, "ActionServer", self._made)
        self.turns = Turns()
        self.serve: Callable[[ServedGoal, Any], ExecutionOutcome] = lambda _goal, _result: DONE
        self.served = GoalServer(
            None,
            MoveGroup,
            "move_action",
            lambda goal, result: self.serve(goal, result),
            lambda _: self.turns,
        )

    def _made(self, _node: Any, _action: Any, _name: str, execute: Any, **callbacks: Any) -> None:
        self.execute = execute
        self.accept = callbacks["handle_accepted_callback"]
        self._cancel = callbacks["cancel_callback"]

    def cancel(self, handle: FakeHandle) -> None:
        """Do as rclpy: first the callback, then the status."""
        self._cancel(handle)
        handle.is_cancel_requested = True


@pytest.fixture
def server(monkeypatch) -> Server:
    return Server(monkeypatch)


def accepted(server: Server, count: int) -> list[FakeHandle]:
    handles = [FakeHandle(number) for number in range(count)]
    for handle in handles:
        server.accept(handle)
    return handles


def test_a_fault_ends_a_goal_with_failure_and_its_reason(server):
    def breaks(_goal: ServedGoal, _result: Any) -> ExecutionOutcome:
        raise RuntimeError("no memory")

    server.serve = breaks
    (handle,) = accepted(server, 1)
    result = server.execute(handle)
    assert handle.status == "aborted"
    assert result.error_code.val == MoveItErrorCode.FAILURE
    assert "move_action has a fault, please report it: RuntimeError: no memory" in (
        result.error_code.message
    )
    assert handle.states[-1] == "IDLE"


def test_goals_begin_one_after_the_other_after_faults_too(server):
    server.serve = lambda _goal, _result: 1 // 0
    handles = accepted(server, 3)
    assert [handle.begun for handle in handles] == [1, 0, 0]
    server.execute(handles[0])
    assert [handle.begun for handle in handles] == [1, 1, 0]


def test_a_waiting_goal_that_is_cancelled_ends_while_another_one_runs(server):
    first, second, third = accepted(server, 3)
    server.cancel(second)
    assert second.begun == 1
    result = server.execute(second)
    assert (second.status, result.error_code.val) == ("canceled", MoveItErrorCode.PREEMPTED)
    assert (first.status, third.begun) == ("", 0)
    server.execute(first)
    assert third.begun == 1


def test_a_goal_learns_while_it_is_served_that_it_is_cancelled(server):
    def plan(goal: ServedGoal, _result: Any) -> ExecutionOutcome:
        server.cancel(goal.handle)
        assert goal.is_interrupted()
        return goal.ending(DONE)

    server.serve = plan
    (handle,) = accepted(server, 1)
    assert server.execute(handle).error_code.message == "the request was cancelled"
    assert handle.status == "canceled"


def test_a_stop_interrupts_only_whose_turn_it_is(server):
    def move(goal: ServedGoal, _result: Any) -> ExecutionOutcome:
        if goal.handle is first:
            server.turns.stop()
        return goal.ending(DONE)

    server.serve = move
    first, second = accepted(server, 2)
    assert server.execute(first).error_code.val == MoveItErrorCode.PREEMPTED
    assert first.status == "aborted"
    assert server.execute(second).error_code.val == MoveItErrorCode.SUCCESS


def test_a_cancel_that_comes_before_the_goal_begins_is_not_lost(server):
    handle = FakeHandle(0)
    server.cancel(handle)
    server.accept(handle)
    assert server.execute(handle).error_code.val == MoveItErrorCode.PREEMPTED


@pytest.mark.parametrize("duration_s", [float("nan"), -1.0, 0.0])
def test_a_goal_waits_for_no_duration_that_is_none(duration_s):
    goal = ServedGoal(FakeHandle(0), MoveGroup.Feedback)
    goal.wait(duration_s)
    assert not goal.is_interrupted()


def test_a_cancelled_goal_waits_no_longer():
    goal = ServedGoal(FakeHandle(0), MoveGroup.Feedback)
    goal.cancel()
    goal.wait(1e300)
    assert goal.is_cancelled
