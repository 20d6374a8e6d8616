"""Find values of a description that are hardly meant: other units, meshes of a wrong size."""

import math
from collections.abc import Iterator

import mujoco
import numpy as np

from arm_description.urdf.robot import (
    Box,
    Capsule,
    Cylinder,
    Geometry,
    Joint,
    Link,
    Mesh,
    Robot,
    Sphere,
)
from arm_gazebo.build_report import BuildOutcome, Finding, as_one
from arm_gazebo.model.built_model import BuiltModel

MANY_TURNS_RAD = 10.0 * math.tau
"""Limits beyond this are doubted: no arm's cables take ten turns, and 90 degrees would be 14."""
FAST_RAD_S = (90.0, 1000.0)
"""Joints of arms turn with up to about 20 rad/s; faster than the second means no limit."""
LONG_M = 20.0
"""A part or a distance of two joints above this is doubted; cranes and bridges are below it."""
LIFTS = 100.0
"""A robot whose joints lift this many times its own weight at its reach is doubted."""
GRAVITY = 9.81


def other_units(robot: Robot, built: BuiltModel) -> Iterator[Finding]:
    """Yield one finding for each kind of value that looks like another unit.

    Args:
        robot: the description.
        built: its model, whose masses are those after repairs.
    """
    yield from _once(_in_degrees(joint) for joint in robot.joints)
    yield from _once(_fast(joint) for joint in robot.joints)
    yield from _once(_long_distance(joint) for joint in robot.joints)
    yield from _once(_long_shape(link) for link in robot.links)
    yield from _light(robot, built)


def _once(findings: Iterator[Finding | None]) -> Iterator[Finding]:
    """Yield the first finding, with the number of the others."""
    found = [finding for finding in findings if finding is not None]
    if found:
        yield as_one(found)


def _in_degrees(joint: Joint) -> Finding | None:
    limit = joint.limit
    if limit is None or not joint.type.turns or not joint.type.needs_limit:
        return None
    if max(-limit.lower, limit.upper) <= MANY_TURNS_RAD:
        return None
    low, high = math.radians(limit.lower), math.radians(limit.upper)
    return _doubt(
        joint,
        f"its limits {limit.lower:g} and {limit.upper:g} are {limit.upper / math.tau:.0f} turns; "
        f'in degrees they would be lower="{low:.4g}" upper="{high:.4g}"',
    )


def _fast(joint: Joint) -> Finding | None:
    if joint.limit is None or not joint.type.turns:
        return None
    speed = joint.limit.velocity
    if not FAST_RAD_S[0] <= speed <= FAST_RAD_S[1]:
        return None
    return _doubt(
        joint,
        f"its velocity {speed:g} rad/s is {speed / math.tau:.0f} turns a second; in degrees it "
        f'would be velocity="{math.radians(speed):.4g}"',
    )


def _long_distance(joint: Joint) -> Finding | None:
    distance = max(map(abs, joint.origin.xyz))
    if distance <= LONG_M:
        return None
    xyz = " ".join(f"{value / 1000:.6g}" for value in joint.origin.xyz)
    return _doubt(
        joint,
        f'its origin is {distance:g} m from its parent; from millimetres it would be xyz="{xyz}"',
    )


def _long_shape(link: Link) -> Finding | None:
    for shape in (*link.visuals, *link.collisions):
        length = _length(shape.geometry)
        if length > LONG_M:
            kind = type(shape.geometry).__name__.lower()
            return Finding(
                BuildOutcome.DOUBTFUL,
                f"link '{link.name}'",
                f"its {kind} is {length:g} m long; from millimetres it would be "
                f"{length / 1000:.4g} m",
                link.line,
            )
    return None


def _length(shape: Geometry) -> float:
    match shape:
        case Box(size):
            return max(size)
        case Cylinder(radius, length) | Capsule(radius, length):
            return max(2.0 * radius, length)
        case Sphere(radius):
            return 2.0 * radius
        case _:
            return 0.0  # `mesh_sizes` looks at meshes.


def _light(robot: Robot, built: BuiltModel) -> Iterator[Finding]:
    """Yield whether the joints' efforts could lift the whole robot many times."""
    mass = float(built.model.body_mass[list(built.bodies.values())].sum())
    reach = sum(math.hypot(*joint.origin.xyz) for joint in robot.joints)
    efforts = [j.limit.effort for j in robot.joints if j.limit is not None and j.type.turns]
    payload = max(efforts, default=0.0) / (GRAVITY * reach) if reach else 0.0
    given = [link for link in robot.links if link.inertial is not None and link.inertial.mass]
    if not given or payload < LIFTS * mass:
        return  # A link without a mass is reported by the builder, which gives it one.
    yield Finding(
        BuildOutcome.DOUBTFUL,
        f"robot '{robot.name}'",
        f"it weighs {_mass(mass)}, but its joints could lift {_mass(payload)} at its reach of "
        f"{reach:.2g} m; are its masses in kg, and its efforts in N m?",
        given[0].line,
    )


def _mass(mass: float) -> str:
    return f"{mass:.3g} kg" if mass >= 0.1 else f"{mass * 1000:.2g} g"


def _doubt(joint: Joint, message: str) -> Finding:
    return Finding(BuildOutcome.DOUBTFUL, f"joint '{joint.name}'", message, joint.line)


INVISIBLE_M = 1e-4
SMALL_M = 1e-3
SMALLER = 100.0
"""A small link is implausible if the distance to its neighbours exceeds its size by this factor."""
LARGE_M = 20.0
LARGER = (1000.0, 200.0)
"""A link is implausible if its size exceeds the distance to its neighbours by this factor; the
second factor applies to links larger than `LARGE_M`."""


def mesh_sizes(robot: Robot, built: BuiltModel) -> Iterator[Finding]:
    """Yield the links whose meshes are too small to see, or far too large.

    A mesh in millimetres without a scale, or one in metres with a scale of 0.001, is wrong by a
    factor of a thousand. The distances between joints, which are always in metres, reveal it. A
    mesh that was replaced by a box does not count.
    """
    for link in robot.links:
        size, distance = _largest_mesh(link, built), _reach(robot, link)
        if not size:
            continue
        if size < INVISIBLE_M or (size < SMALL_M and distance > SMALLER * size):
            yield _finding(link, f"only {_metres(size)} large, too small to see", distance)
        elif 0.0 < distance < size / LARGER[size > LARGE_M]:
            yield _finding(link, f"{_metres(size)} large", distance)


def _finding(link: Link, problem: str, distance: float) -> Finding:
    shapes = (*link.visuals, *link.collisions)
    mesh = next(s.geometry for s in shapes if isinstance(s.geometry, Mesh))
    scale = " ".join(f"{factor:g}" for factor in mesh.scale)
    near = f", but the next joint is {_metres(distance)} away" if distance else ""
    return Finding(
        BuildOutcome.DOUBTFUL,
        f"link '{link.name}'",
        f"its mesh {mesh.uri} is {problem}{near}; is its scale, {scale}, right?",
        link.line,
    )


def _largest_mesh(link: Link, built: BuiltModel) -> float:
    """Return the longest side of the bounding boxes of a link's meshes in m, 0 without meshes."""
    model, body = built.model, built.bodies.get(link.name, -1)
    mine = (model.geom_bodyid == body) & (model.geom_type == mujoco.mjtGeom.mjGEOM_MESH)
    return 2.0 * float(np.max(model.geom_aabb[mine, 3:], initial=0.0))


def _reach(robot: Robot, link: Link) -> float:
    """Return the distance in m to the farthest neighbouring joint, or else of any joint."""
    near = [joint for joint in robot.joints if link.name in (joint.parent, joint.child)]
    far = max((math.hypot(*joint.origin.xyz) for joint in near), default=0.0)
    return far or max((math.hypot(*joint.origin.xyz) for joint in robot.joints), default=0.0)


def _metres(length: float) -> str:
    return f"{length:.3g} m" if length >= 0.1 else f"{length * 1000:.2g} mm"
