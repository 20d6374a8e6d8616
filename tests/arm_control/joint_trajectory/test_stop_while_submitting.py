"""A goal comes on one thread while the loop thread stops the controller, at every possible moment.

The client's thread is stopped before each bytecode instruction of the controller in turn; what the
loop thread does at that moment is done there and then, so that each of the orders is met once.
"""

import inspect
import sys
from collections.abc import Callable
from types import FrameType
from typing import Any

import pytest

from arm_control.joint_trajectory import GoalRequest, GoalResult, JointTrajectoryController
from arm_control.joint_trajectory.results import NOT_RUNNING

MakeRig = Callable[..., Any]

POINT = [(0.5, [1.0, 2.0, 3.0])]
FILE = inspect.getfile(JointTrajectoryController)


class Interruption:
    """Calls something before one of the instructions that the controller's module executes.

    Attributes:
        happened: whether there were that many instructions.
    """

    def __init__(self, action: Callable[[], None], instruction: int) -> None:
        self.happened = False
        self._action = action
        self._left = instruction

    def during(self, call: Callable[[], Any]) -> Any:
        """Return what the call returns."""
        before = sys.gettrace()
        sys.settrace(self._trace)
        try:
            return call()
        finally:
            sys.settrace(before)

    def _trace(self, frame: FrameType, event: str, _argument: Any) -> Any:
        if frame.f_code.co_filename != FILE:
            return None
        frame.f_trace_opcodes = True
        if event == "opcode" and not self.happened:
            self._left -= 1
            if self._left < 0:
                self.happened = True
                # What a trace function calls is not traced.
                self._action()
        return self._trace


def outcomes(make_rig: MakeRig, act: Callable[[Any], Any], **options: Any) -> list[tuple[Any, Any]]:
    """Return the result, and the rig, of each moment at which the controller can be stopped."""
    ended: list[tuple[Any, Any]] = []
    while True:
        rig = make_rig(**options)
        interruption = Interruption(rig.deactivate, len(ended))
        result = interruption.during(lambda rig=rig: act(rig))
        if not interruption.happened:
            return ended
        ended.append((result, rig))


@pytest.mark.parametrize("checks_limits", [False, True])
def test_the_goal_ends_once(
    make_rig: MakeRig,
    make_request: Callable[..., Any],
    robot_description: Callable[..., str],
    checks_limits: bool,
) -> None:
    ended = outcomes(
        make_rig,
        lambda rig: rig.controller.submit_goal(GoalRequest("goal", make_request(POINT))),
        robot_description=robot_description(),
        check_position_limits=checks_limits,
    )
    refused = [result for result, rig in ended if result is not None and not rig.sink.results]
    served = [rig.result for result, rig in ended if result is None]
    assert len(refused) + len(served) == len(ended)
    assert set(refused) == {NOT_RUNNING.as_result()}
    assert served
    assert all(isinstance(result, GoalResult) for result in served)


def test_a_trajectory_is_dropped_in_silence_or_refused(
    make_rig: MakeRig, make_request: Callable[..., Any]
) -> None:
    ended = outcomes(make_rig, lambda rig: rig.controller.submit_trajectory(make_request(POINT)))
    assert {refusal for refusal, _ in ended} == {None, NOT_RUNNING}
