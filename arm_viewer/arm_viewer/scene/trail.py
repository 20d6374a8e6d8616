"""The way that a point has gone, as a line in the 3D view."""

import math
from collections import deque

import numpy as np
from viser import LineSegmentsHandle, SceneApi

from arm_node.rigid_transform import Vector

ROOT = "/trail"
COLOUR = (214, 51, 132)
THICKNESS_M = 0.002
SPACING_M = 0.002
"""Points nearer to the last one than this are left out."""
MAX_STEP_M = 0.5
"""A longer step is a jump, and begins a new line."""
CHUNK, CHUNKS = 50, 40
"""Points of one node of the scene, which alone is sent again; most nodes."""


class PointTrail:
    """Draws the newest CHUNK x CHUNKS points; use it in viser's event loop."""

    def __init__(self, scene: SceneApi) -> None:
        """Start empty."""
        self._scene = scene
        self._points: list[Vector] = []
        self._is_new = False
        self._nodes: deque[LineSegmentsHandle] = deque()
        self._open: LineSegmentsHandle | None = None
        self._number = 0

    def add(self, point: Vector) -> None:
        """Add a point in the world's frame, in m."""
        step_m = math.dist(point, self._points[-1]) if self._points else math.inf
        if step_m < SPACING_M:
            return
        if step_m > MAX_STEP_M or len(self._points) > CHUNK:
            self.draw()
            # The next node goes on where this one ends.
            self._points = self._points[-1:] if step_m <= MAX_STEP_M else []
            self._open = None
        self._points.append(point)
        self._is_new = True

    def draw(self) -> None:
        """Send what is new."""
        if not self._is_new or len(self._points) < 2:
            return
        self._is_new = False
        ends = np.array(self._points, dtype=np.float32)
        segments = np.stack([ends[:-1], ends[1:]], axis=1)
        if self._open is not None:
            self._open.points = segments
            return
        self._number += 1
        self._open = self._scene.add_line_segments(
            f"{ROOT}/{self._number}", segments, COLOUR, thickness=THICKNESS_M
        )
        self._nodes.append(self._open)
        if len(self._nodes) > CHUNKS:
            self._nodes.popleft().remove()

    def clear(self) -> None:
        """Remove the line."""
        self._points, self._open, self._is_new = [], None, False
        while self._nodes:
            self._nodes.pop().remove()
