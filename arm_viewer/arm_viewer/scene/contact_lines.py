"""The points at which things touch and the forces there, in the 3D view."""

import numpy as np
from numpy.typing import NDArray
from viser import LineSegmentsHandle, PointCloudHandle, SceneApi

from arm_node.rigid_transform import RigidTransform
from arm_viewer.scene.frames import Frames
from arm_viewer.snapshot import ContactForces

ROOT = "/contacts"
POINT_M, LINE_M = 0.012, 0.004
POINT_RGB, FORCE_RGB = (255, 190, 0), (220, 30, 30)
ORIGIN = RigidTransform()


class ContactLines:
    """Draws contacts; use it in viser's event loop."""

    def __init__(self, scene: SceneApi, frames: Frames) -> None:
        """Draw into this scene, at the poses of these frames."""
        self._scene = scene
        self._frames = frames
        self._shown: ContactForces | None = None
        self._points: PointCloudHandle | None = None
        self._lines: LineSegmentsHandle | None = None

    def show(self, contacts: ContactForces | None) -> None:
        """Show these contacts in place of those before; None shows none."""
        if contacts is self._shown:
            return
        self._shown = contacts
        if contacts is None or not len(contacts.points):
            for handle in filter(None, (self._points, self._lines)):
                handle.remove()
            self._points = self._lines = None
            return
        matrix = np.array(self._frames.known.get(contacts.frame, ORIGIN).matrix())
        points, lines = _moved(contacts.points, matrix), _moved(contacts.lines, matrix)
        if self._points is None or self._lines is None:
            self._points = self._scene.add_point_cloud(
                f"{ROOT}/points", points, POINT_RGB, point_size=POINT_M, point_shape="circle"
            )
            self._lines = self._scene.add_line_segments(
                f"{ROOT}/forces", lines, FORCE_RGB, thickness=LINE_M
            )
        else:
            self._points.points, self._lines.points = points, lines


def _moved(places: NDArray[np.float32], matrix: NDArray[np.float64]) -> NDArray[np.float32]:
    """Return places (..., 3) of a frame whose pose is a matrix (4, 4), in the scene."""
    return (places @ matrix[:3, :3].T + matrix[:3, 3]).astype(np.float32)
