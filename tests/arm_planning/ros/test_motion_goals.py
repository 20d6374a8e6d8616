"""The course of a goal that plans and moves."""

from types import SimpleNamespace
from typing import Any

from moveit_msgs.msg import PlanningOptions

from arm_planning.errors import MoveItErrorCode
from arm_planning.ros.goals import Turns
from arm_planning.ros.motion_goals import MotionGoals
from arm_planning.ros.trajectory_executor import ExecutionOutcome


def test_remarks_on_a_plan_stay_in_the_answer_after_the_motion():
    session: Any = SimpleNamespace(monitor=SimpleNamespace(scene=None), watch=lambda *_: None)
    moved = ExecutionOutcome(MoveItErrorCode.SUCCESS)
    executor: Any = SimpleNamespace(execute=lambda *_: moved)
    display: Any = None
    goals = MotionGoals(
        session, executor, display, allows_execution=True, moving=Turns(), planning=Turns()
    )
    goal: Any = SimpleNamespace(
        request=SimpleNamespace(planning_options=PlanningOptions()),
        say=lambda _: None,
        is_interrupted=lambda: False,
        ending=lambda outcome: outcome,
    )
    trajectory: Any = None
    planned = ExecutionOutcome(MoveItErrorCode.SUCCESS, "the goal is moved"), (trajectory,)
    assert goals.serve(goal, lambda: planned) == planned[0]
