"""Constraints with a share of their tolerances."""

from dataclasses import replace

from arm_description.urdf.robot import Box, Cylinder, Sphere
from arm_planning.constraints.constraints import (
    JointConstraint,
    MotionConstraints,
    OrientationConstraint,
    PositionConstraint,
)
from arm_planning.scene.shapes import Cone, Shape


def tightened(constraints: MotionConstraints, share: float) -> MotionConstraints:
    """Return constraints with a share of their tolerances; meshes and half spaces stay."""
    return replace(
        constraints,
        joints=tuple(_joint(each, share) for each in constraints.joints),
        positions=tuple(_position(each, share) for each in constraints.positions),
        orientations=tuple(_orientation(each, share) for each in constraints.orientations),
    )


def _joint(each: JointConstraint, share: float) -> JointConstraint:
    # The middle of the two tolerances stays where it is.
    middle = each.position + (each.above - each.below) / 2.0
    half = share * (each.above + each.below) / 2.0
    return replace(each, position=middle, above=half, below=half)


def _position(each: PositionConstraint, share: float) -> PositionConstraint:
    regions = tuple(replace(region, shape=_shape(region.shape, share)) for region in each.regions)
    return replace(each, regions=regions)


def _orientation(each: OrientationConstraint, share: float) -> OrientationConstraint:
    x, y, z = each.tolerances
    return replace(each, tolerances=(share * x, share * y, share * z))


def _shape(shape: Shape, share: float) -> Shape:
    match shape:
        case Box():
            x, y, z = shape.size
            return Box((share * x, share * y, share * z))
        case Sphere():
            return Sphere(share * shape.radius)
        case Cylinder():
            return Cylinder(share * shape.radius, share * shape.length)
        case Cone():
            return Cone(share * shape.radius, share * shape.height)
        case _:
            return shape
