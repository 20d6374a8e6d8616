"""A translucent robot at a planned state, and the line that its tip draws."""

import math
from collections.abc import Collection

import numpy as np
from numpy.typing import NDArray
from viser import FrameHandle, MeshHandle, SceneApi, SceneNodeHandle

from arm_node.rigid_transform import RigidTransform
from arm_planning.robot.model import JointPositions, PlanningModel
from arm_planning.scene.frames import LinkPoses
from arm_viewer.scene.frames import node_name
from arm_viewer.scene.link_layers import draw_collisions, draw_visuals

Colour = tuple[int, int, int]
OPACITY = 0.45
COLLIDING: Colour = (224, 30, 40)
TRAIL_M = 0.003
SAME_M, SAME_RAD = 0.002, 0.02
"""A link that is nearer than this to the real one would only tint it."""


class Ghost:
    """Draws a robot when it is first shown; use it in viser's event loop."""

    def __init__(self, scene: SceneApi, name: str, model: PlanningModel, colour: Colour) -> None:
        """Prepare a robot without drawing it; links that touch nothing get this colour."""
        self._scene = scene
        self._path = f"/planning/{node_name(name)}"
        self._model = model
        self._colour = colour
        self._root: FrameHandle | None = None
        self._links: dict[str, FrameHandle] = {}
        self._meshes: dict[str, list[MeshHandle]] = {}
        self._shown: tuple[RigidTransform, JointPositions, JointPositions] | None = None
        self._colliding: frozenset[str] = frozenset()

    def show(
        self,
        origin: RigidTransform,
        positions: JointPositions,
        present: JointPositions,
        colliding: Collection[str] = (),
    ) -> None:
        """Show the robot, but for links that are where the real ones are and touch nothing.

        Joints without a position are where they are at present; colliding links get the colour of
        collisions. The origin is the pose of the root link in the scene.
        """
        root = self._root = self._root or self._draw()
        has_changed = self._colliding != frozenset(colliding)
        if has_changed:
            self._colliding = frozenset(colliding)
            self._set_colours()
        if has_changed or self._shown is None or self._shown != (origin, positions, present):
            self._shown = (origin, positions, present)
            _place(root, origin)
            poses = LinkPoses(self._model, {**present, **positions})
            now = LinkPoses(self._model, present)
            for link, frame in self._links.items():
                frame.visible = link in self._colliding or differ(poses[link], now[link])
                _place(frame, poses[link])
        if not root.visible:
            root.visible = True

    def hide(self) -> None:
        """Hide it."""
        if self._root is not None and self._root.visible:
            self._root.visible = False

    def remove(self) -> None:
        """Remove it from the scene."""
        if self._root is not None:
            self._root.remove()
            self._root = None

    def _draw(self) -> FrameHandle:
        root = self._scene.add_frame(self._path, show_axes=False, visible=False)
        for link in self._model.robot.links:
            path = f"{self._path}/{node_name(link.name)}"
            self._links[link.name] = self._scene.add_frame(path, show_axes=False)
            draw = draw_visuals if link.visuals else draw_collisions
            # `RobotPanel` lists meshes that cannot be drawn.
            handles: list[SceneNodeHandle] = list(
                draw(self._scene, path, link, lambda problem: None)
            )
            meshes = [handle for handle in handles if isinstance(handle, MeshHandle)]
            for mesh in meshes:
                mesh.opacity, mesh.cast_shadow = OPACITY, False
            self._meshes[link.name] = meshes
        self._set_colours()
        return root

    def _set_colours(self) -> None:
        for link, meshes in self._meshes.items():
            colour = COLLIDING if link in self._colliding else self._colour
            for mesh in meshes:
                if mesh.color != colour:
                    mesh.color = colour


class Trail:
    """A line in the scene; use it in viser's event loop."""

    def __init__(self, scene: SceneApi, name: str, colour: Colour) -> None:
        """Prepare a line without drawing it; `name` is unique among the scene's nodes."""
        self._scene = scene
        self._path = f"/planning/{node_name(name)}"
        self._colour = colour
        self._line: SceneNodeHandle | None = None

    def show(self, origin: RigidTransform, points: NDArray[np.float64]) -> None:
        """Draw the line through points (n, 3), in m in the frame at `origin`."""
        self.hide()
        x, y, z, w = origin.rotation
        self._line = self._scene.add_line_segments(
            self._path,
            np.stack([points[:-1], points[1:]], axis=1).astype(np.float32),
            self._colour,
            thickness=TRAIL_M,
            position=origin.position,
            wxyz=(w, x, y, z),
        )

    def hide(self) -> None:
        """Remove the line."""
        if self._line is not None:
            self._line.remove()
            self._line = None


def differ(first: RigidTransform, second: RigidTransform) -> bool:
    """Return whether two poses of a link can be told apart in the scene."""
    cosine = abs(sum(a * b for a, b in zip(first.rotation, second.rotation, strict=True)))
    turn_rad = 2.0 * math.acos(min(cosine, 1.0))
    return math.dist(first.position, second.position) > SAME_M or turn_rad > SAME_RAD


def _place(frame: FrameHandle, pose: RigidTransform) -> None:
    x, y, z, w = pose.rotation
    frame.position, frame.wxyz = pose.position, (w, x, y, z)
