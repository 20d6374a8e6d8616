"""The world's shapes in the 3D view."""

import logging
from collections.abc import Callable, Mapping

import numpy as np
from numpy.typing import NDArray
from viser import FrameHandle, MeshHandle, SceneApi

from arm_description.errors import DescriptionError
from arm_description.mesh.data import MeshData, merged
from arm_description.urdf.robot import Box, Cylinder, Mesh, Sphere
from arm_description.view_fitting import Body, body_of
from arm_node.rigid_transform import RigidTransform
from arm_viewer.scene.first_view import Obstacles
from arm_viewer.scene.frames import Frames, node_name
from arm_viewer.scene.poses import Poses
from arm_viewer.scene.triangles import smooth, triangles
from arm_viewer.snapshot import Marker, MarkerLook, MarkerShape

ROOT = "/world"
ORIGIN = RigidTransform()
GROUND_M, GROUND_THICKNESS_M = 5.0, 0.05
"""A box at least this long and wide, and thinner than this, counts as ground."""
OPAQUE = 0.9
INSIDE_OPACITY = 0.45
"""Of shapes while one looks inside."""
Matrix = NDArray[np.float64]
_SOLIDS = {
    MarkerShape.BOX: Box((1.0, 1.0, 1.0)),
    MarkerShape.BALL: Sphere(0.5),
    MarkerShape.CYLINDER: Cylinder(0.5, 1.0),
}


class Markers:
    """Draws the markers at their poses; use it in viser's event loop."""

    def __init__(
        self,
        scene: SceneApi,
        frames: Frames,
        poses: Poses,
        on_click: Callable[[str], None],
    ) -> None:
        """Draw into this scene, in these frames, and move the markers by `poses`.

        `on_click` takes the namespace of a marker that was clicked, in viser's threads.
        """
        self._scene = scene
        self._on_click = on_click
        self._poses = poses
        self._frames = frames
        self._seen: Mapping[str, Marker] = {}
        self._origins: dict[str, RigidTransform] = {}
        self._handles: dict[str, FrameHandle] = {}
        self._parts: dict[str, list[MeshHandle]] = {}
        self._is_transparent = False
        self._root = scene.add_frame(ROOT, show_axes=False)

    def show(self, shown: bool, transparent: bool) -> None:
        """Show or hide all markers, and let one see what is inside them or not."""
        if transparent != self._is_transparent:
            self._is_transparent = transparent
            for name, parts in self._parts.items():
                for part in parts:
                    part.opacity = self._opacity(self._seen[name].look)
        if self._root.visible != shown:
            self._root.visible = shown

    def update(self, markers: Mapping[str, Marker]) -> None:
        """Draw new markers, move changed ones and remove old ones."""
        for name in self._handles.keys() - markers.keys():
            self._remove(name)
        for name, marker in markers.items():
            before = self._seen.get(name)
            # A frame without a transform counts as the root, because the world frame is the root.
            origin = self._frames.known.get(marker.frame, ORIGIN)
            if before is marker and self._origins[name] is origin:
                continue
            if before is None or before.look != marker.look:
                self._draw(name, marker.look)
            self._origins[name] = origin
            self._poses.move(self._handles[name], origin.then(marker.pose))
        self._seen = markers

    def _opacity(self, look: MarkerLook) -> float | None:
        alpha = min(look.rgba[3], INSIDE_OPACITY if self._is_transparent else 1.0)
        return None if alpha >= 1.0 else alpha

    def bodies(self) -> tuple[list[Body], Obstacles]:
        """Return the bodies of the markers, without the ground, and the obstacles to the view."""
        bodies: list[Body] = []
        boxes: list[tuple[Matrix, Matrix, Matrix, Matrix]] = []
        for name, marker in self._seen.items():
            matrix = np.array(self._origins[name].then(marker.pose).matrix())
            turn, move = matrix[:3, :3], matrix[:3, 3]
            for part in _parts(name, marker.look):
                points = part.vertices * marker.look.scale
                low, high = points.min(axis=0), points.max(axis=0)
                is_mesh = marker.look.shape in (MarkerShape.MESH, MarkerShape.TRIANGLES)
                placed = points @ turn.T + move
                faces = placed[part.faces] if is_mesh else np.empty((0, 3, 3))
                bodies.append(body_of(placed))
                # Transparent shapes hide nothing.
                if marker.look.rgba[3] >= OPAQUE:
                    boxes.append((turn, turn @ (low + high) / 2 + move, (high - low) / 2, faces))
        turns, centres, halves = (np.array([box[i] for box in boxes]) for i in range(3))
        return bodies, Obstacles(turns, centres, halves, [box[3] for box in boxes])

    def _remove(self, name: str) -> None:
        handle = self._handles.pop(name)
        del self._parts[name]
        self._poses.forget(handle)
        handle.remove()

    def _draw(self, name: str, look: MarkerLook) -> None:
        if name in self._handles:
            self._remove(name)
        path = f"{ROOT}/{node_name(name)}"
        self._handles[name] = self._scene.add_frame(path, show_axes=False)
        red, green, blue, _ = look.rgba
        self._parts[name] = []
        for i, part in enumerate(_parts(name, look)):
            mesh = smooth(part.scaled(look.scale))
            drawn = self._scene.add_mesh_simple(
                f"{path}/part_{i}",
                mesh.vertices,
                mesh.faces,
                color=(red, green, blue),
                opacity=self._opacity(look),
                side="double",
                # The shadow map is too coarse for small objects and would draw stripes on them.
                receive_shadow=False,
            )
            self._parts[name].append(drawn)
            drawn.on_click(lambda _: self._on_click(name.split("/")[-2]))


def _is_ground(look: MarkerLook) -> bool:
    """Return whether it is the ground, which the page draws as a grid."""
    length, width, height = look.scale
    is_wide = min(length, width) >= GROUND_M
    return look.shape is MarkerShape.BOX and is_wide and height < GROUND_THICKNESS_M


def _parts(name: str, look: MarkerLook) -> tuple[MeshData, ...]:
    if _is_ground(look):
        return ()
    try:
        if look.shape is MarkerShape.TRIANGLES:
            # Drop an incomplete triangle at the end.
            points = np.frombuffer(look.points, dtype=np.float32)
            return (merged(points[: len(points) // 9 * 9].reshape(-1, 3)),)
        if look.shape is MarkerShape.MESH:
            return triangles(Mesh(look.mesh_uri))
        return triangles(_SOLIDS[look.shape])
    except DescriptionError as error:
        logging.getLogger(__name__).warning("cannot draw %s: %s", name, error)
        return ()
