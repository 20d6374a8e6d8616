"""The 3D view of a browser as a camera of the robot sees it, until its user wants it free again.

It is part of the served page (`front/view_from.*`). A browser names an image topic; while it does,
it is sent the pose of that topic's camera whenever that changes, and moves its own view there.
"""

from collections.abc import Mapping
from dataclasses import dataclass

from viser import GuiApi

from arm_node.rigid_transform import RigidTransform, rotated
from arm_viewer.channel import Browser, Channel, Message
from arm_viewer.scene.frames import Frames
from arm_viewer.snapshot import CameraView, Snapshot

WISH, POSE = "view_from", "view_from_pose"
"""Kinds of messages: the topic whose camera a browser looks from, "" for none; where that is."""
TARGET_M = 0.5
"""Distance from the camera to the point about which its user can then turn the view."""


@dataclass(slots=True)
class _Looking:
    """The topic that a browser looks from, and what it was told last."""

    topic: str
    told: tuple[CameraView | None, RigidTransform | None] | None = None


class ViewFromCamera:
    """Tells each browser where the camera is that it looks from; use it in viser's event loop."""

    def __init__(self, channel: Channel, frames: Frames) -> None:
        """Use the page's channel, and the poses of these frames."""
        self._channel = channel
        self._frames = frames
        self._looking: dict[Browser, _Looking] = {}

    def build(self, gui: GuiApi) -> None:
        """Serve the browsers."""
        self._channel.on(WISH, self._take_wish, changes=False)

    def update(self, snapshot: Snapshot) -> None:
        """Tell the browsers whose camera has moved."""
        for browser, looking in list(self._looking.items()):
            if not browser.is_connected:
                del self._looking[browser]
                continue
            view = camera_of(looking.topic, snapshot.cameras)
            pose = None if view is None else self._frames.known.get(view.frame)
            if looking.told is None or looking.told[0] != view or looking.told[1] is not pose:
                looking.told = view, pose
                browser.send(POSE, {"topic": looking.topic, **_place(looking.topic, view, pose)})

    def _take_wish(self, message: Message, browser: Browser) -> None:
        topic = message.text("topic")
        self._looking.pop(browser, None)
        if topic:
            self._looking[browser] = _Looking(topic)


def camera_of(topic: str, cameras: Mapping[str, CameraView]) -> CameraView | None:
    """Return the camera of an image topic, or None.

    Its CameraInfo is beside the image, as image_transport has it, or below it.
    """
    beside = f"{topic.rpartition('/')[0]}/camera_info"
    return cameras.get(beside) or cameras.get(f"{topic}/camera_info")


def _place(topic: str, view: CameraView | None, pose: RigidTransform | None) -> dict[str, object]:
    """Return the eye, target and up direction, and tangents of half the view's width and height."""
    if view is None:
        return {"problem": f"No CameraInfo beside or below {topic}"}
    if pose is None:
        return {"problem": f"No transform on /tf for {view.frame}"}
    (fx, fy), (cx, cy) = view.focal_lengths, view.centre
    ahead = rotated(pose.rotation, (0.0, 0.0, TARGET_M))
    return {
        "position": pose.position,
        "target": [a + b for a, b in zip(pose.position, ahead, strict=True)],
        "up": rotated(pose.rotation, (0.0, -1.0, 0.0)),
        "half": (max(cx, view.width - cx) / fx, max(cy, view.height - cy) / fy),
        "problem": "",
    }
