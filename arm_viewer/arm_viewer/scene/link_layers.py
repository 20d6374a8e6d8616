"""What can be shown of a link, each drawn below the link's frame."""

import logging
import math
from collections.abc import Callable, Iterator

from viser import SceneApi, SceneNodeHandle

from arm_description.errors import DescriptionError
from arm_description.mesh_data import Color, MeshData
from arm_description.robot import Collision, Link, Pose, Visual
from arm_description.transforms import quaternion_from_rpy
from arm_viewer.scene.frame_poses import product
from arm_viewer.scene.inertia_ellipsoid import inertia_ellipsoid
from arm_viewer.scene.triangles import edges, problem_of, smooth, triangles

VISUAL_COLOR: Color = (0.62, 0.65, 0.69, 1.0)
COLLISION_COLOR = (255, 176, 64)
COLLISION_LINE_M = 0.0012
MASS_COLOR = (255, 120, 90)
INERTIA_COLOR = (90, 190, 255)
INERTIA_OPACITY = 0.45
LEAD_DENSITY = 11340.0
"""kg/m^3: a mass is shown as a ball of lead, as in RViz."""

Complain = Callable[[str], None]
"""Takes a line about what of a link cannot be drawn."""
Quaternion = tuple[float, float, float, float]


def draw_visuals(
    scene: SceneApi, path: str, link: Link, complain: Complain
) -> Iterator[SceneNodeHandle]:
    """Draw what the link looks like; each handle has an opacity, None where it is solid."""
    for i, visual in enumerate(link.visuals):
        for k, mesh in enumerate(_parts(link, visual, complain)):
            red, green, blue, alpha = _color(visual) or mesh.rgba or VISUAL_COLOR
            drawn = smooth(mesh)
            yield scene.add_mesh_simple(
                f"{path}/visual_{i}_{k}",
                drawn.vertices,
                drawn.faces,
                color=(red, green, blue),
                opacity=None if alpha >= 1.0 else alpha,
                side="double",
                position=visual.origin.xyz,
                wxyz=_wxyz(visual.origin),
            )


def draw_collisions(
    scene: SceneApi, path: str, link: Link, complain: Complain
) -> Iterator[SceneNodeHandle]:
    """Draw the edges of what the link is touched by."""
    for i, collision in enumerate(link.collisions):
        for k, mesh in enumerate(_parts(link, collision, complain)):
            yield scene.add_line_segments(
                f"{path}/collision_{i}_{k}",
                edges(mesh),
                COLLISION_COLOR,
                thickness=COLLISION_LINE_M,
                position=collision.origin.xyz,
                wxyz=_wxyz(collision.origin),
            )


def draw_mass(
    scene: SceneApi, path: str, link: Link, complain: Complain
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
    scene: SceneApi, path: str, link: Link, complain: Complain
) -> Iterator[SceneNodeHandle]:
    """Draw the solid ellipsoid of the link's mass and inertia."""
    ellipsoid = None if link.inertial is None else inertia_ellipsoid(link.inertial)
    if link.inertial is not None and ellipsoid is not None:
        axes, turned = ellipsoid
        a, b, c, d = quaternion_from_rpy(link.inertial.origin.rpy).tolist()
        x, y, z, w = product((a, b, c, d), turned)
        yield scene.add_icosphere(
            f"{path}/inertia",
            radius=1.0,
            scale=axes,
            color=INERTIA_COLOR,
            opacity=INERTIA_OPACITY,
            position=link.inertial.origin.xyz,
            wxyz=(w, x, y, z),
        )


def _parts(link: Link, shape: Visual | Collision, complain: Complain) -> tuple[MeshData, ...]:
    try:
        return triangles(shape.geometry)
    except DescriptionError as error:
        logging.getLogger(__name__).warning("link '%s' is not whole: %s", link.name, error)
        complain(f"link '{link.name}': {problem_of(error)}")
        return ()


def _color(visual: Visual) -> Color | None:
    return None if visual.material is None else visual.material.rgba


def _wxyz(pose: Pose) -> Quaternion:
    x, y, z, w = quaternion_from_rpy(pose.rpy).tolist()
    return w, x, y, z
