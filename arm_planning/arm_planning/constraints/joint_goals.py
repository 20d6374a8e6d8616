"""Goals of joints that lie beyond a limit."""

from collections.abc import Callable
from dataclasses import replace

from arm_planning.constraints.constraints import JointConstraint, MotionConstraints
from arm_planning.robot.model import JointGroup, PlanningLimits

SNAPPED_TOLERANCE = 1e-9
"""Tolerance of a goal that was moved to a limit, rad or m."""


def snap_to_limits(
    goal: MotionConstraints, group: JointGroup, warn: Callable[[str], None]
) -> MotionConstraints:
    """Return a goal whose joints can be reached, as MoveIt does it.

    A joint whose whole tolerance is beyond a limit gets the limit as its goal, and `warn` is told.
    """
    limits = dict(zip(group.joints, group.limits, strict=True))
    joints = tuple(
        _snap(each, limits[each.joint], warn) if each.joint in limits else each
        for each in goal.joints
    )
    return replace(goal, joints=joints)


def _snap(
    goal: JointConstraint, limits: PlanningLimits, warn: Callable[[str], None]
) -> JointConstraint:
    if goal.position - goal.below > limits.upper:
        limit = limits.upper
    elif goal.position + goal.above < limits.lower:
        limit = limits.lower
    else:
        return goal
    warn(
        f"the goal of joint '{goal.joint}', {goal.position:.4g}, is beyond its limit; "
        f"{limit:.4g} is used"
    )
    return replace(goal, position=limit, above=SNAPPED_TOLERANCE, below=SNAPPED_TOLERANCE)
