"""The drawable layers of a link: visuals, collisions, mass and inertia."""

import logging
import math
from collections.abc import Callable, Iterator

import numpy as np
from viser import SceneApi, SceneNodeHandle
from viser.transforms import SO3

from arm_description.errors import DescriptionError
from arm_description.mesh.data import Color, MeshData
from arm_description.transforms import quaternion_from_rpy, wxyz_from_rpy
from arm_description.urdf.robot import Collision, Inertial, Link, Visual
from arm_node.rigid_transform import Quaternion, Vector, quaternion_product
from arm_viewer.scene.triangles import edges, problem_of, smooth, triangles

VISUAL_COLOR: Color = (0.62, 0.65, 0.69, 1.0)
COLLISION_COLOR = (255, 176, 64)
COLLISION_LINE_M = 0.0012
MASS_COLOR = (255, 120, 90)
INERTIA_COLOR = (90, 190, 255)
INERTIA_OPACITY = 0.45
LEAD_DENSITY = 11340.0
"""Density in kg/m^3 for drawing a mass as a ball of lead, as in RViz."""

ReportProblem = Callable[[str], None]
"""Takes a line about a part of a link that cannot be drawn."""


def inertia_ellipsoid(inertial: Inertial) -> tuple[Vector, Quaternion] | None:
    """Return the ellipsoid's semi-axes in m, and their rotation in the frame of the inertial.

    A solid ellipsoid with the semi-axes a, b, c has Ixx = m (b^2 + c^2) / 5 and so on, hence
    a^2 = 5 (Iyy + Izz - Ixx) / 2 m. The rotation is a unit quaternion (x, y, z, w).

    Returns:
        None if the inertia is impossible: no mass, or a moment above the sum of the others.
    """
    ixx, ixy, ixz, iyy, iyz, izz = inertial.inertia
    values = np.array([[ixx, ixy, ixz], [ixy, iyy, iyz], [ixz, iyz, izz]])
    if not (inertial.mass > 0.0 and np.isfinite(values).all()):
        return None
    moments, axes = np.linalg.eigh(values)
    squares = 2.5 * (moments.sum() - 2.0 * moments) / inertial.mass
    # A rod or a plate is the limiting case, and rounding may make it slightly impossible.
    if squares.min() < -1e-9 * max(squares.max(), 0.0) or squares.max() <= 0.0:
        return None
    if np.linalg.det(axes) < 0.0:
        axes[:, 2] = -axes[:, 2]
    a, b, c = np.sqrt(np.maximum(squares, 0.0)).tolist()
    w, x, y, z = SO3.from_matrix(axes).wxyz.tolist()
    return (a, b, c), (x, y, z, w)


def draw_visuals(
    scene: SceneApi, path: str, link: Link, report_problem: ReportProblem
) -> Iterator[SceneNodeHandle]:
    """Draw the link's visuals; each handle has an opacity, None if it is solid."""
    for i, visual in enumerate(link.visuals):
        for k, mesh in enumerate(_parts(link, visual, report_problem)):
            red, green, blue, alpha = _color(visual) or mesh.rgba or VISUAL_COLOR
            drawn = smooth(mesh)
            yield scene.add_mesh_simple(
                f"{path}/visual_{i}_{k}",
                drawn.vertices,
                drawn.faces,
                color=(red, green, blue),
                opacity=None if alpha >= 1.0 else alpha,
                side="double",
                # The shadow map is too coarse for small objects and would draw stripes on them.
                receive_shadow=False,
                position=visual.origin.xyz,
                wxyz=wxyz_from_rpy(visual.origin.rpy),
            )


def draw_collisions(
    scene: SceneApi, path: str, link: Link, report_problem: ReportProblem
) -> Iterator[SceneNodeHandle]:
    """Draw the edges of the link's collision shapes."""
    for i, collision in enumerate(link.collisions):
        for k, mesh in enumerate(_parts(link, collision, report_problem)):
            yield scene.add_line_segments(
                f"{path}/collision_{i}_{k}",
                edges(mesh),
                COLLISION_COLOR,
                thickness=COLLISION_LINE_M,
                position=collision.origin.xyz,
                wxyz=wxyz_from_rpy(collision.origin.rpy),
            )


def draw_mass(
    scene: SceneApi, path: str, link: Link, report_problem: ReportProblem
) -> Iterator[SceneNodeHandle]:
    """Draw a ball at the link's centre of mass."""
    if link.inertial is not None and link.inertial.mass > 0.0:
        volume = link.inertial.mass / LEAD_DENSITY
        yield scene.add_icosphere(
            f"{path}/mass",
            radius=math.cbrt(0.75 * volume / math.pi),
            color=MASS_COLOR,
            position=link.inertial.origin.xyz,
        )


def draw_inertia(
    scene: SceneApi, path: str, link: Link, report_problem: ReportProblem
) -> Iterator[SceneNodeHandle]:
    """Draw the solid ellipsoid of the link's mass and inertia."""
    ellipsoid = None if link.inertial is None else inertia_ellipsoid(link.inertial)
    if link.inertial is not None and ellipsoid is not None:
        axes, rotation = ellipsoid
        turned = quaternion_from_rpy(link.inertial.origin.rpy).tolist()
        x, y, z, w = quaternion_product(turned, rotation)
        yield scene.add_icosphere(
            f"{path}/inertia",
            radius=1.0,
            scale=axes,
            color=INERTIA_COLOR,
            opacity=INERTIA_OPACITY,
            position=link.inertial.origin.xyz,
            wxyz=(w, x, y, z),
        )


def _parts(
    link: Link, shape: Visual | Collision, report_problem: ReportProblem
) -> tuple[MeshData, ...]:
    try:
        return triangles(shape.geometry)
    except DescriptionError as error:
        logging.getLogger(__name__).warning("link '%s' is incomplete: %s", link.name, error)
        report_problem(f"link '{link.name}': {problem_of(error)}")
        return ()


def _color(visual: Visual) -> Color | None:
    return None if visual.material is None else visual.material.rgba
