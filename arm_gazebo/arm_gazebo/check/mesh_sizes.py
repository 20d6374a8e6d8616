"""Find meshes with an implausible size."""

import math
from collections.abc import Iterator

import mujoco
import numpy as np

from arm_description.urdf.robot import Link, Mesh, Robot
from arm_gazebo.build_report import BuildOutcome, Finding
from arm_gazebo.model.built_model import BuiltModel

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
    factor of a thousand. The distances between joints, which are always in metres, reveal it.

    Args:
        robot: the description.
        built: its model; a mesh that was replaced by a box does not count.
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
