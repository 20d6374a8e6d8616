"""Robots with planning groups, for tests of motion planning."""

import math

from arm_description import expand_xacro, parse_urdf
from arm_description.resources import ResourceFinder
from arm_description.urdf.robot import Robot
from arm_planning.robot.model import JointGroup, PlanningLimits, PlanningModel
from arm_planning.scene.allowed_collisions import AllowedCollisions

MYCOBOT = "package://mycobot_description/urdf/robots/mycobot_280.urdf.xacro"


def model_of(urdf: str | Robot, **groups: tuple[tuple[str, ...], str]) -> PlanningModel:
    """A model whose groups are given as names of joints and the tip, "" for none."""
    robot = parse_urdf(urdf) if isinstance(urdf, str) else urdf
    active = tuple(
        joint.name
        for joint in robot.joints_in_tree_order
        if joint.type.is_scalar and joint.mimic is None
    )
    return PlanningModel(
        robot,
        robot.root,
        active,
        {name: group_of(robot, name, joints, tip) for name, (joints, tip) in groups.items()},
    )


def group_of(robot: Robot, name: str, joints: tuple[str, ...], tip: str) -> JointGroup:
    """A group with the limits of the URDF, and 3 per s^2."""
    found = [robot.joint(joint) for joint in joints]
    limits = tuple(
        PlanningLimits(
            -math.inf if joint.type.wraps or joint.limit is None else joint.limit.lower,
            math.inf if joint.type.wraps or joint.limit is None else joint.limit.upper,
            joint.limit.velocity if joint.limit is not None else 3.0,
            3.0,
        )
        for joint in found
    )
    wraps = tuple(joint.type.wraps for joint in found)
    links = tuple(joint.child for joint in found)
    return JointGroup(name, joints, wraps, limits, links, found[0].parent, tip)


def mycobot() -> PlanningModel:
    """The myCobot 280 with the group `arm`."""
    robot = parse_urdf(expand_xacro(ResourceFinder().find(MYCOBOT)))
    names = tuple(joint.name for joint in robot.joints_in_tree_order if "link" in joint.name)
    arm = tuple(name for name in names if robot.joint(name).type.is_scalar)
    return model_of(robot, arm=(arm, "gripper_base"))


def neighbours(model: PlanningModel) -> AllowedCollisions:
    """Links that a joint connects may touch."""
    pairs = [tuple(sorted((joint.parent, joint.child))) for joint in model.robot.joints]
    return AllowedCollisions({(first, second): True for first, second in pairs})
