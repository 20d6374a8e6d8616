"""The cameras in the 3D view, drawn as frustums."""

from collections.abc import Mapping

import numpy as np
from numpy.typing import NDArray
from viser import LineSegmentsHandle, SceneApi

from arm_viewer.scene.frames import Frames, node_name
from arm_viewer.snapshot import CameraView

DEPTH_M = 0.12
"""Distance from the camera to the rectangle that represents its image."""
MARK = 0.12
"""Height of the triangle on the image's upper edge, as a fraction of the image's height."""
COLOUR = (150, 165, 185)
LINE_M = 0.001


class Cameras:
    """Draws a frustum in every camera's optical frame; use it in viser's event loop."""

    def __init__(self, scene: SceneApi, frames: Frames) -> None:
        """Draw into this scene, below these frames."""
        self._scene = scene
        self._frames = frames
        self._handles: dict[CameraView, LineSegmentsHandle] = {}

    def update(self, views: Mapping[str, CameraView], shown: bool) -> None:
        """Draw new cameras, remove old ones, and show or hide all; each is drawn once."""
        wanted = {view: topic for topic, view in views.items()} if shown else {}
        for view in self._handles.keys() - wanted:
            self._handles.pop(view).remove()
        for view in wanted.keys() - self._handles:
            self._handles[view] = self._scene.add_line_segments(
                f"{self._frames.path(view.frame)}/{node_name(wanted[view])}",
                frustum(view),
                COLOUR,
                thickness=LINE_M,
            )


def frustum(view: CameraView) -> NDArray[np.float32]:
    """Return the lines (n, 2, 3) of a camera's frustum, with a triangle on its upper edge.

    In m in the optical frame, whose z axis points forward and y axis down (REP 103).
    """
    width, height = view.width, view.height
    corners = [(0.0, 0.0), (width, 0.0), (width, height), (0.0, height)]
    roof = [(0.4 * width, 0.0), (0.5 * width, -MARK * height), (0.6 * width, 0.0)]
    rim = [_point_at(view, *pixel) for pixel in corners]
    lines = [((0.0, 0.0, 0.0), corner) for corner in rim]
    lines += zip(rim, [*rim[1:], rim[0]], strict=True)
    left, top, right = (_point_at(view, *pixel) for pixel in roof)
    return np.array([*lines, (left, top), (top, right)], dtype=np.float32)


def _point_at(view: CameraView, u: float, v: float) -> tuple[float, float, float]:
    """Return the point at a pixel, DEPTH_M in front of the camera."""
    (fx, fy), (cx, cy) = view.focal_lengths, view.centre
    return DEPTH_M * (u - cx) / fx, DEPTH_M * (v - cy) / fy, DEPTH_M
