"""Runs trajectories on controllers: whatever ends it, the robot is stopped."""

import threading
from collections.abc import Callable
from dataclasses import replace
from types import SimpleNamespace
from typing import Any

import numpy as np
import pytest
from action_msgs.msg import GoalStatus

from arm_planning.errors import MoveItErrorCode
from arm_planning.execution import ControllerKind, ExecutionSettings, TrajectoryController
from arm_planning.ros import trajectory_executor
from arm_planning.ros.trajectory_executor import ExecutionManager
from arm_planning.trajectory import TimedTrajectory

ARM = TrajectoryController(
    "arm_controller", "follow", ControllerKind.FOLLOW_JOINT_TRAJECTORY, ("a",)
)
MOTION = TimedTrajectory(
    ("a",), np.array([0.0, 1.0]), np.array([[0.0], [0.5]]), np.zeros((2, 1)), np.zeros((2, 1))
)


class Answer:
    """A future: it completes once, maybe before somebody asks."""

    def __init__(self, result: Any = None, *, is_done: bool = True) -> None:
        self._result, self._is_done = result, is_done
        self._waiting: list[Callable[[Any], None]] = []

    def add_done_callback(self, call: Callable[[Any], None]) -> None:
        if self._is_done:
            call(self)
        else:
            self._waiting.append(call)

    def complete(self, result: Any) -> None:
        self._result, self._is_done = result, True
        for call in self._waiting:
            call(self)

    def result(self) -> Any:
        return self._result


class Controller:
    """A controller's action, as the client sees it; it moves until it is cancelled."""

    def __init__(self, *_arguments: Any, **_options: Any) -> None:
        self.cancels = 0
        self.lost_cancels = 0
        self.accepted = True
        self.answer = Answer(self)
        self._end = Answer(is_done=False)

    def wait_for_server(self, _timeout_s: float) -> bool:
        return True

    def server_is_ready(self) -> bool:
        return True

    def send_goal_async(self, _goal: Any) -> Answer:
        return self.answer

    def get_result_async(self) -> Answer:
        return self._end

    def cancel_goal_async(self) -> None:
        self.cancels += 1
        if self.cancels > self.lost_cancels:
            self.end(GoalStatus.STATUS_CANCELED)

    def end(self, status: int, **result: Any) -> None:
        self._end.complete(SimpleNamespace(status=status, result=SimpleNamespace(**result)))


class States:
    """A robot that stands at the start."""

    stamp_s = 0.0
    speed = 0.0

    def wait_for_fresh(self, *_arguments: Any) -> str:
        return ""

    def positions(self) -> dict[str, float]:
        return {"a": 0.0}

    def largest_speed(self) -> float:
        return self.speed


@pytest.fixture
def controller(monkeypatch) -> Controller:
    made = Controller()
    monkeypatch.setattr(trajectory_executor, "NotedActionClient", lambda *_, **__: made)
    return made


@pytest.fixture
def states() -> States:
    return States()


@pytest.fixture
def manager(states) -> ExecutionManager:
    return ExecutionManager(None, states, lambda: [ARM], ExecutionSettings())


def test_an_error_of_the_watch_stops_the_robot(manager, controller):
    def watch(_elapsed_s: float) -> str:
        raise ValueError("the scene cannot be read")

    with pytest.raises(ValueError, match="the scene cannot be read"):
        manager.execute(MOTION, (), watch)
    assert controller.cancels == 1


def test_after_an_error_the_next_motion_runs(manager, controller):
    def watch(_elapsed_s: float) -> str:
        controller.end(GoalStatus.STATUS_SUCCEEDED)
        raise ValueError("no scene")

    with pytest.raises(ValueError, match="no scene"):
        manager.execute(MOTION, (), watch)
    assert manager.execute(MOTION).code is MoveItErrorCode.SUCCESS


def test_what_blocks_the_way_stops_the_robot(manager, controller):
    outcome = manager.execute(MOTION, (), lambda _: "box with link2")
    assert outcome.code is MoveItErrorCode.MOTION_PLAN_INVALIDATED_BY_ENVIRONMENT_CHANGE
    assert outcome.message == "the way ahead is no longer free: box with link2"
    assert controller.cancels == 1


def test_a_wish_to_cancel_that_is_lost_is_sent_again(manager, controller):
    controller.lost_cancels = 1
    outcome = manager.execute(MOTION, (), lambda _: "box")
    assert controller.cancels == 2
    assert "may still move" not in outcome.message


def test_a_controller_that_does_not_stop_is_named(manager, controller, monkeypatch):
    monkeypatch.setattr(trajectory_executor, "STOP_TIMEOUT_S", 0.02)
    controller.lost_cancels = 1000
    outcome = manager.execute(MOTION, (), lambda _: "box")
    assert "arm_controller did not say within 0.02 s that it stopped" in outcome.message


def test_an_interrupted_motion_is_stopped(manager, controller):
    interrupted = iter([False, False, True])
    outcome = manager.execute(MOTION, (), None, lambda: next(interrupted))
    assert outcome.code is MoveItErrorCode.PREEMPTED
    assert controller.cancels == 1


def test_what_is_interrupted_before_it_begins_does_not_move(manager, controller):
    outcome = manager.execute(MOTION, (), None, lambda: True)
    assert outcome.code is MoveItErrorCode.PREEMPTED
    assert controller.cancels == 0


def test_at_the_end_the_robot_stops_and_no_other_motion_begins(manager, controller):
    ending = threading.Thread(target=manager.end)

    def watch(_elapsed_s: float) -> str:
        if ending.ident is None:
            ending.start()
        return ""

    outcome = manager.execute(MOTION, (), watch)
    ending.join()
    assert outcome.code is MoveItErrorCode.PREEMPTED
    assert controller.cancels == 1
    assert manager.execute(MOTION).code is MoveItErrorCode.PREEMPTED


def test_the_time_of_a_motion_counts_from_when_its_controller_takes_it(manager, controller, states):
    controller.answer = Answer(is_done=False)
    elapsed: list[float] = []

    def watch(elapsed_s: float) -> str:
        elapsed.append(elapsed_s)
        if len(elapsed) == 1:
            states.stamp_s = 10.0
        elif len(elapsed) == 2:
            controller.answer.complete(controller)
            states.stamp_s = 11.0
        else:
            controller.end(GoalStatus.STATUS_SUCCEEDED)
        return ""

    assert manager.execute(MOTION, (), watch).code is MoveItErrorCode.SUCCESS
    assert elapsed == [0.0, 0.0, 1.0]


def test_the_time_of_a_motion_goes_on_when_the_clock_is_set_back(manager, controller, states):
    # The fifth is a snapshot with this motion: the motion goes back, too.
    stamps = iter([100.2, 0.05, 0.15, 0.1, 0.6])
    elapsed: list[float] = []

    def watch(elapsed_s: float) -> str:
        elapsed.append(elapsed_s)
        if (stamp_s := next(stamps, None)) is None:
            controller.end(GoalStatus.STATUS_SUCCEEDED)
        else:
            states.stamp_s = stamp_s
        return ""

    states.stamp_s = 100.0
    assert manager.execute(MOTION, (), watch).code is MoveItErrorCode.SUCCESS
    assert elapsed == pytest.approx([0.0, 0.2, 0.2, 0.3, 0.25, 0.75])


def test_a_motion_that_takes_too_long_is_stopped(manager, controller, states):
    def watch(_elapsed_s: float) -> str:
        states.stamp_s, states.speed = 10.0, 0.1
        return ""

    outcome = manager.execute(MOTION, (), watch)
    assert outcome.code is MoveItErrorCode.TIMED_OUT
    assert controller.cancels == 1


def test_a_robot_that_stands_still_may_have_arrived_though_its_controller_is_late_to_say_so(
    manager, controller, states
):
    looks: list[float] = []

    def watch(elapsed_s: float) -> str:
        states.stamp_s = 10.0
        looks.append(elapsed_s)
        if len(looks) == 3:
            controller.end(GoalStatus.STATUS_SUCCEEDED)
        return ""

    assert manager.execute(MOTION, (), watch).code is MoveItErrorCode.SUCCESS
    assert looks == [0.0, 10.0, 10.0]


def test_a_robot_that_never_arrives_is_not_waited_for(manager, controller, states, monkeypatch):
    monkeypatch.setattr(trajectory_executor, "ANSWER_TIMEOUT_S", 0.02)

    def watch(_elapsed_s: float) -> str:
        states.stamp_s = 10.0
        return ""

    assert manager.execute(MOTION, (), watch).code is MoveItErrorCode.TIMED_OUT


def test_a_refused_part_of_a_controllers_joints_is_named(controller, states):
    both = replace(ARM, joints=("a", "b"))
    manager: Any = ExecutionManager(None, states, lambda: [both], ExecutionSettings())
    controller.accepted = False
    assert "it has nothing for b, which only" in manager.execute(MOTION).message


@pytest.mark.parametrize(("error_code", "is_advised"), [(-5, True), (-4, True), (-1, False)])
def test_a_robot_that_something_holds_up_may_touch_what_the_scene_lacks(
    manager, controller, error_code, is_advised
):
    controller.end(GoalStatus.STATUS_ABORTED, error_code=error_code, error_string="j rests")
    outcome = manager.execute(MOTION)
    assert outcome.code is MoveItErrorCode.CONTROL_FAILED
    assert outcome.message.startswith("controller 'arm_controller' gave up: j rests")
    assert ("the floor, that the planning scene lacks" in outcome.message) is is_advised


def test_a_refused_motion_names_the_controller(manager, controller):
    controller.accepted = False
    outcome = manager.execute(MOTION)
    assert outcome.code is MoveItErrorCode.CONTROL_FAILED
    assert outcome.message == (
        "controller 'arm_controller' refused the trajectory; is it active? "
        "`arm control list_controllers` and its log tell"
    )
