"""Makes the model that planning works with, from a URDF, its SRDF and joint_limits.yaml."""

import logging
import math
from collections.abc import Container, Iterator, Mapping, Sequence
from itertools import pairwise

from arm_description.urdf.robot import Joint, Robot
from arm_node.names import listing
from arm_planning.robot.limits import JointLimitSettings, Warn, limits_of
from arm_planning.robot.model import JointGroup, JointPositions, PlanningLimits, PlanningModel
from arm_planning.robot.srdf import Srdf

_logger = logging.getLogger(__name__)


def planning_model(
    robot: Robot,
    srdf: Srdf,
    limits: JointLimitSettings | None = None,
    warn: Warn = _logger.warning,
) -> PlanningModel:
    """Return the robot with its groups, limits and named states.

    Args:
        robot: the robot.
        srdf: what `parse_srdf` read for it, or `default_srdf` made.
        limits: the content of joint_limits.yaml.
        warn: receives sentences about what is assumed or passed over; by default they are logged.

    Raises:
        PlanningError: the limits of a joint contradict each other.
    """
    settings = limits or JointLimitSettings()
    active = [
        joint
        for joint in robot.joints_in_tree_order
        if joint.type.is_scalar and joint.mimic is None
    ]
    _warn_of_unknown(robot, settings, warn)
    bounds = limits_of(active, settings, warn)
    groups = {name: _group(robot, srdf, name, bounds) for name in srdf.groups}
    return PlanningModel(
        robot=robot,
        frame=_frame(robot, srdf),
        joints=tuple(bounds),
        groups=groups,
        states={key: _state(values, bounds) for key, values in srdf.states.items()},
    )


def group_joints(robot: Robot, srdf: Srdf, group: str) -> tuple[Joint, ...]:
    """Return all joints of a group in tree order, fixed and mimic ones included."""
    names: set[str] = set()
    waiting, seen = [group], {group}
    carriers = {joint.child: joint.name for joint in robot.joints}
    while waiting:
        parts = srdf.groups[waiting.pop()]
        names.update(parts.joints)
        names.update(carriers[link] for link in parts.links if link in carriers)
        for base, tip in parts.chains:
            names.update(_joints_between(robot, base, tip))
        waiting.extend(inner for inner in parts.subgroups if inner not in seen)
        seen.update(parts.subgroups)
    return tuple(joint for joint in robot.joints_in_tree_order if joint.name in names)


def _group(robot: Robot, srdf: Srdf, name: str, bounds: Mapping[str, PlanningLimits]) -> JointGroup:
    joints = group_joints(robot, srdf, name)
    active = [joint for joint in joints if joint.name in bounds]
    limits = tuple(bounds[joint.name] for joint in active)
    is_chain = _is_chain(robot, joints)
    return JointGroup(
        name=name,
        joints=tuple(joint.name for joint in active),
        continuous=tuple(
            joint.type.turns and _is_endless(limit)
            for joint, limit in zip(active, limits, strict=True)
        ),
        limits=limits,
        links=tuple(joint.child for joint in joints),
        base=joints[0].parent if is_chain else "",
        tip=joints[-1].child if is_chain else "",
    )


def _is_endless(limit: PlanningLimits) -> bool:
    return limit.lower == -math.inf and limit.upper == math.inf


def _is_chain(robot: Robot, joints: Sequence[Joint]) -> bool:
    """Return whether each joint carries the next one, directly or by fixed joints only."""
    carriers = {joint.child: joint for joint in robot.joints}
    for before, after in pairwise(joints):
        carrier = carriers.get(after.parent)
        while carrier is not None and carrier is not before and not carrier.type.is_scalar:
            carrier = carriers.get(carrier.parent)
        if carrier is not before:
            return False
    return bool(joints)


def _joints_between(robot: Robot, base: str, tip: str) -> set[str]:
    """Return the joints on the way from one link to another, up and down the tree."""
    return set(_joints_above(robot, base)) ^ set(_joints_above(robot, tip))


def _joints_above(robot: Robot, link: str) -> Iterator[str]:
    carriers = {joint.child: joint for joint in robot.joints}
    while link in carriers:
        yield carriers[link].name
        link = carriers[link].parent


def _frame(robot: Robot, srdf: Srdf) -> str:
    """Return the planning frame; only a virtual joint that moves gives another than the root."""
    for joint in srdf.virtual_joints:
        if joint.child_link == robot.root and joint.type != "fixed":
            return joint.parent_frame
    return robot.root


def _state(values: Mapping[str, Sequence[float]], active: Container[str]) -> JointPositions:
    return {joint: numbers[0] for joint, numbers in values.items() if joint in active}


def _warn_of_unknown(robot: Robot, settings: JointLimitSettings, warn: Warn) -> None:
    known = {joint.name for joint in robot.joints}
    unknown = [joint for joint in settings.joints if joint not in known]
    if unknown:
        warn(f"joint_limits are given for joints that the robot does not have: {listing(unknown)}")
