"""The world's shapes in the 3D view."""

import logging
from collections.abc import Mapping

import numpy as np
from viser import FrameHandle, SceneApi

from arm_description.errors import DescriptionError
from arm_description.mesh_data import MeshData, merged
from arm_description.robot import Box, Cylinder, Mesh, Sphere
from arm_viewer.scene.frame_poses import FramePose
from arm_viewer.scene.frames import Frames
from arm_viewer.scene.node_name import node_name
from arm_viewer.scene.triangles import smooth, triangles
from arm_viewer.snapshot import Marker, MarkerLook, MarkerShape, Transform

ROOT = "/world"
ORIGIN = FramePose()
GROUND_M, GROUND_THICKNESS_M = 5.0, 0.05
"""A box so long and wide, and so thin, is taken for the ground."""
_SOLIDS = {
    MarkerShape.BOX: Box((1.0, 1.0, 1.0)),
    MarkerShape.BALL: Sphere(0.5),
    MarkerShape.CYLINDER: Cylinder(0.5, 1.0),
}


class Markers:
    """Keeps the markers where they are said to be; use it in viser's event loop."""

    def __init__(self, scene: SceneApi, frames: Frames) -> None:
        """Draw into this scene, in these frames."""
        self._scene = scene
        self._frames = frames
        self._seen: Mapping[str, Marker] = {}
        self._origins: dict[str, FramePose] = {}
        self._handles: dict[str, FrameHandle] = {}
        self._root = scene.add_frame(ROOT, show_axes=False)

    def show(self, shown: bool) -> None:
        """Show or hide them all."""
        self._root.visible = shown

    def update(self, markers: Mapping[str, Marker]) -> None:
        """Draw what is new, move what has moved, remove what is gone."""
        for name in self._handles.keys() - markers.keys():
            self._handles.pop(name).remove()
        for name, marker in markers.items():
            before = self._seen.get(name)
            # A frame without a transform is taken for the root, which the world's frame is.
            origin = self._frames.known.get(marker.frame, ORIGIN)
            if before is marker and self._origins[name] is origin:
                continue
            if before is None or before.look != marker.look:
                self._draw(name, marker.look)
            self._origins[name] = origin
            pose = origin.then(Transform(marker.frame, marker.position, marker.rotation))
            x, y, z, w = pose.rotation
            self._handles[name].position = pose.position
            self._handles[name].wxyz = (w, x, y, z)
        self._seen = markers

    def _draw(self, name: str, look: MarkerLook) -> None:
        if name in self._handles:
            self._handles.pop(name).remove()
        path = f"{ROOT}/{node_name(name)}"
        self._handles[name] = self._scene.add_frame(path, show_axes=False)
        red, green, blue, alpha = look.rgba
        for i, part in enumerate(_parts(name, look)):
            mesh = smooth(part.scaled(look.scale))
            self._scene.add_mesh_simple(
                f"{path}/part_{i}",
                mesh.vertices,
                mesh.faces,
                color=(red, green, blue),
                opacity=None if alpha >= 1.0 else alpha,
                side="double",
            )


def _is_ground(look: MarkerLook) -> bool:
    """Return whether it is the ground, for which the page has its grid."""
    length, width, height = look.scale
    is_wide = min(length, width) >= GROUND_M
    return look.shape is MarkerShape.BOX and is_wide and height < GROUND_THICKNESS_M


def _parts(name: str, look: MarkerLook) -> tuple[MeshData, ...]:
    if _is_ground(look):
        return ()
    try:
        if look.shape is MarkerShape.TRIANGLES:
            # Cut to whole triangles: what is left over draws nothing.
            points = np.frombuffer(look.points, dtype=np.float32)
            return (merged(points[: len(points) // 9 * 9].reshape(-1, 3)),)
        if look.shape is MarkerShape.MESH:
            return triangles(Mesh(look.mesh_uri))
        return triangles(_SOLIDS[look.shape])
    except DescriptionError as error:
        logging.getLogger(__name__).warning("cannot draw %s: %s", name, error)
        return ()
