"""Pairs of links that may touch because of the joints between them."""

from collections.abc import Iterator

import numpy as np

from arm_description.transforms import rotation_from_rpy
from arm_description.urdf.joint_type import JointType
from arm_description.urdf.robot import Robot
from arm_planning.robot.srdf import Pair

PARALLEL = 1e-6
"""How far the cosine of the angle between axes that count as parallel may be from 1."""


def joined(robot: Robot) -> Iterator[Pair]:
    """Yield the pairs of links that a joint connects, or several with empty links between."""
    carriers = {joint.child: joint.parent for joint in robot.joints}
    solid = {link.name for link in robot.links if link.collisions}
    for link in solid:
        above = carriers.get(link)
        while above is not None and above not in solid:
            above = carriers.get(above)
        if above is not None:
            yield min(link, above), max(link, above)


def telescopes(robot: Robot) -> Iterator[Pair]:
    """Yield the pairs of links with one or more joints between them that slide along one line."""
    carriers = {joint.child: joint for joint in robot.joints}
    for link in robot.links:
        above, rotation, line = carriers.get(link.name), np.eye(3), None
        while above is not None and above.type in (JointType.FIXED, JointType.PRISMATIC):
            if above.type is JointType.PRISMATIC:
                axis = rotation.T @ above.axis
                if line is not None and abs(axis @ line) < 1.0 - PARALLEL:
                    break
                line = axis
            if line is not None:
                yield min(link.name, above.parent), max(link.name, above.parent)
            rotation = rotation_from_rpy(above.origin.rpy) @ rotation
            above = carriers.get(above.parent)


def beside_wheels(robot: Robot) -> Iterator[Pair]:
    """Yield the pairs of links that turn about each other endlessly: one joint is between them."""
    bases = {link.name: link.name for link in robot.links}
    for joint in robot.joints_in_tree_order:
        if joint.type is JointType.FIXED:
            bases[joint.child] = bases[joint.parent]
    for joint in robot.joints:
        if joint.type is JointType.CONTINUOUS:
            turning = [link for link, base in bases.items() if base == bases[joint.child]]
            beside = [link for link, base in bases.items() if base == bases[joint.parent]]
            yield from ((min(a, b), max(a, b)) for a in turning for b in beside)
