"""The frames of /tf in the 3D view; what belongs to a frame hangs below it."""

from collections.abc import Mapping

from viser import FrameHandle, LabelHandle, SceneApi

from arm_viewer.scene.frame_poses import FramePose, frame_poses
from arm_viewer.scene.node_name import node_name
from arm_viewer.snapshot import Transform

AXES_LENGTH, AXES_RADIUS = 0.06, 0.0018
NO_MOTION = 1e-6
"""m, or of a quaternion's component: less than this is not sent."""


class Frames:
    """Keeps every frame where the transforms say; use it in viser's event loop.

    The frames stand beside each other, not below their parents: a parent that comes late or changes
    leaves what hangs below a frame alone. A frame without a transform is not shown.
    """

    def __init__(self, scene: SceneApi) -> None:
        """Start without frames."""
        self._scene = scene
        self._seen: Mapping[str, Transform] = {}
        self._poses: dict[str, FramePose] = {}
        self._handles: dict[str, FrameHandle] = {}
        self._names: dict[str, LabelHandle] = {}
        self._axes_shown = False
        self._names_shown = False

    @property
    def known(self) -> Mapping[str, FramePose]:
        """The frames that have a place."""
        return self._poses

    def path(self, frame: str) -> str:
        """Return the scene's name of a frame, under which shapes may be hung."""
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
        """Move the frames to where they are."""
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


def _differ(first: FramePose, second: FramePose) -> bool:
    return any(
        abs(a - b) > NO_MOTION
        for a, b in zip(
            (*first.position, *first.rotation), (*second.position, *second.rotation), strict=True
        )
    )
