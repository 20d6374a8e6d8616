"""The planning scene in the 3D view: translucent objects, those on the robot in another colour."""

import math
from collections.abc import Iterator
from dataclasses import dataclass

import numpy as np
import trimesh
from viser import FrameHandle, SceneApi

from arm_description.mesh.data import MeshData
from arm_node.rigid_transform import RigidTransform
from arm_planning.scene.frames import LinkPoses
from arm_planning.scene.objects import CollisionObject, PlacedShape
from arm_planning.scene.scene import PlanningScene
from arm_planning.scene.shapes import Cone, Plane, Shape, TriangleMesh
from arm_viewer.scene.frames import node_name
from arm_viewer.scene.ghost import Colour
from arm_viewer.scene.triangles import ROUND_SECTIONS, smooth, triangles

WORLD_COLOUR: Colour = (50, 165, 75)
ATTACHED_COLOUR: Colour = (145, 70, 190)
OPACITY = 0.5
PLANE_M = 2.0
"""Side of the square that stands for a plane."""


@dataclass(frozen=True, slots=True)
class _Drawn:
    frame: FrameHandle
    look: object
    pose: RigidTransform


class PlanningObjects:
    """Draws an object again only when its shapes have changed; use it in viser's event loop."""

    def __init__(self, scene: SceneApi, name: str) -> None:
        """Draw into this scene; `name` is unique among its nodes."""
        self._scene = scene
        self._path = f"/planning/{node_name(name)}"
        self._drawn: dict[str, _Drawn] = {}

    def update(self, scene: PlanningScene | None, origin: RigidTransform, links: LinkPoses) -> None:
        """Show the objects of a scene, if any, at the pose of the planning frame in the 3D view."""
        wanted: dict[str, tuple[CollisionObject, Colour, RigidTransform]] = {}
        if scene is not None:
            for each in scene.objects.values():
                wanted[each.id] = (each, WORLD_COLOUR, origin.then(each.pose))
            for body in scene.attached.values():
                held = origin.then(links[body.link]).then(body.object.pose)
                wanted[body.object.id] = (body.object, ATTACHED_COLOUR, held)
        for name in self._drawn.keys() - wanted.keys():
            self._drawn.pop(name).frame.remove()
        for name, (each, colour, pose) in wanted.items():
            self._show(name, each, colour, pose)

    def remove(self) -> None:
        """Remove all objects from the 3D view."""
        for drawn in self._drawn.values():
            drawn.frame.remove()
        self._drawn.clear()

    def _show(self, name: str, each: CollisionObject, colour: Colour, pose: RigidTransform) -> None:
        look = (colour, tuple((_key(placed.shape), placed.pose) for placed in each.shapes))
        drawn = self._drawn.get(name)
        if drawn is not None and drawn.look == look and drawn.pose == pose:
            return
        if drawn is None or drawn.look != look:
            if drawn is not None:
                drawn.frame.remove()
            frame = self._draw(name, each.shapes, colour)
        else:
            frame = drawn.frame
        x, y, z, w = pose.rotation
        frame.position, frame.wxyz = pose.position, (w, x, y, z)
        self._drawn[name] = _Drawn(frame, look, pose)

    def _draw(self, name: str, shapes: tuple[PlacedShape, ...], colour: Colour) -> FrameHandle:
        path = f"{self._path}/{node_name(name)}"
        frame = self._scene.add_frame(path, show_axes=False)
        for number, placed in enumerate(shapes):
            x, y, z, w = placed.pose.rotation
            for part, mesh in enumerate(_meshes(placed.shape)):
                self._scene.add_mesh_simple(
                    f"{path}/shape_{number}_{part}",
                    mesh.vertices,
                    mesh.faces,
                    color=colour,
                    opacity=OPACITY,
                    side="double",
                    cast_shadow=False,
                    receive_shadow=False,
                    position=placed.pose.position,
                    wxyz=(w, x, y, z),
                )
        return frame


def _key(shape: Shape) -> object:
    """Return what tells a shape from others; meshes themselves compare by identity."""
    if isinstance(shape, TriangleMesh):
        return shape.vertices.tobytes(), shape.triangles.tobytes()
    return shape


def _meshes(shape: Shape) -> Iterator[MeshData]:
    match shape:
        case TriangleMesh(vertices, faces):
            yield MeshData(vertices, faces.astype(np.int32))
        case Plane():
            yield _square(shape)
        case Cone(radius, height):
            solid = trimesh.creation.cone(radius, height, sections=ROUND_SECTIONS)
            base = np.asarray(solid.vertices) - (0.0, 0.0, 0.5 * height)
            yield smooth(MeshData(base, np.asarray(solid.faces, dtype=np.int32)))
        case _:
            yield from map(smooth, triangles(shape))


def _square(plane: Plane) -> MeshData:
    """Return a square of the plane's surface around the point that is nearest to the origin."""
    length = math.hypot(plane.a, plane.b, plane.c)
    normal = np.array([plane.a, plane.b, plane.c], dtype=np.float64) / length
    across = np.cross(normal, np.eye(3)[int(np.argmin(np.abs(normal)))])
    across *= 0.5 * PLANE_M / math.hypot(*across.tolist())
    along = np.cross(normal, across)
    corners = np.array([across + along, across - along, -across - along, along - across])
    vertices = np.asarray(corners - plane.d / length * normal, dtype=np.float64)
    return MeshData(vertices, np.array([[0, 1, 2], [0, 2, 3]], dtype=np.int32))
