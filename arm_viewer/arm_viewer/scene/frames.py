"""The frames of /tf in the 3D view; shapes are children of their frames."""

from collections.abc import Mapping

from viser import FrameHandle, LabelHandle, SceneApi

from arm_node.rigid_transform import RigidTransform
from arm_viewer.scene.frame_poses import frame_poses
from arm_viewer.snapshot import Transform


def node_name(name: str) -> str:
    """Return a name for a single scene node; a slash would create nested nodes."""
    return name.replace("/", "\N{DIVISION SLASH}")


AXES_LENGTH, AXES_RADIUS = 0.06, 0.0018
NO_MOTION = 1e-6
"""A smaller change, in m or of a quaternion's component, is not sent."""


class Frames:
    """Draws every frame at its transform; use it in viser's event loop.

    The scene nodes of frames are siblings and not nested like the frames, so that a parent that
    arrives late or changes does not affect them. A frame without a transform is hidden.
    """

    def __init__(self, scene: SceneApi) -> None:
        """Start without frames."""
        self._scene = scene
        self._seen: Mapping[str, Transform] = {}
        self._poses: dict[str, RigidTransform] = {}
        self._handles: dict[str, FrameHandle] = {}
        self._names: dict[str, LabelHandle] = {}
        self._axes_shown = False
        self._names_shown = False

    @property
    def known(self) -> Mapping[str, RigidTransform]:
        """The frames that have a pose."""
        return self._poses

    def path(self, frame: str) -> str:
        """Return the scene path of a frame, below which shapes can be added."""
        if frame not in self._handles:
            self._handles[frame] = self._scene.add_frame(
                _path(frame),
                show_axes=self._axes_shown,
                axes_length=AXES_LENGTH,
                axes_radius=AXES_RADIUS,
                origin_radius=AXES_RADIUS * 1.5,
                visible=False,
            )
        return _path(frame)

    def update(self, transforms: Mapping[str, Transform]) -> None:
        """Move the frames to their transforms."""
        if transforms is self._seen:
            return
        self._seen = transforms
        poses = frame_poses(transforms)
        for frame, pose in poses.items():
            before = self._poses.get(frame)
            if before is None:
                self.path(frame)
                self._handles[frame].visible = True
                self._name(frame)
            elif not _differ(before, pose):
                poses[frame] = before
                continue
            handle = self._handles[frame]
            x, y, z, w = pose.rotation
            handle.position, handle.wxyz = pose.position, (w, x, y, z)
        for frame in self._poses.keys() - poses.keys():
            self._handles[frame].visible = False
        self._poses = poses

    def show_axes(self, shown: bool) -> None:
        """Show or hide the axes of all frames."""
        if shown != self._axes_shown:
            self._axes_shown = shown
            for handle in self._handles.values():
                handle.show_axes = shown

    def show_names(self, shown: bool) -> None:
        """Show or hide the names of all frames."""
        if shown != self._names_shown:
            self._names_shown = shown
            for frame in self._poses:
                self._name(frame)

    def _name(self, frame: str) -> None:
        if frame in self._names:
            self._names[frame].visible = self._names_shown
        elif self._names_shown:
            self._names[frame] = self._scene.add_label(
                f"{self.path(frame)}/name", frame, font_screen_scale=0.7
            )


def _path(frame: str) -> str:
    return f"/frames/{node_name(frame)}"


def _differ(first: RigidTransform, second: RigidTransform) -> bool:
    return any(
        abs(a - b) > NO_MOTION
        for a, b in zip(
            (*first.position, *first.rotation), (*second.position, *second.rotation), strict=True
        )
    )
