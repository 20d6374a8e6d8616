"""The poses of scene nodes on their way to the browsers.

A moving arm changes twenty poses thirty times a second. viser compares, stores and packs each by
itself. Here all poses of a tick are one binary frame of the page's own channel, and
`front/poses.js` hands them to viser's client. viser itself gets them when nothing moves, for the
browsers that come later, and at once while there is a browser whose script has not asked for them.
"""

import struct
from collections.abc import Callable

from viser import SceneNodeHandle

from arm_node.rigid_transform import RigidTransform
from arm_viewer.channel import Browser, Channel, Message

ASKED = "poses"
"""A browser's message: its script can move nodes."""
NAMES = "pose_names"
"""The message to the browsers that lists the nodes, in the order of their numbers."""
FRAME = 1
"""The kind of the binary frames.

They have a ROW for each node: its number, its position in m, and its rotation (w, x, y, z)."""
ROW = struct.Struct("<8f")
REST_S = 0.5
"""Nodes that have not moved for this long are at rest."""


class Poses:
    """Moves nodes in all browsers; use it in viser's event loop."""

    def __init__(self, channel: Channel, count_browsers: Callable[[], int]) -> None:
        """Move them over this channel; `count_browsers` returns how many browsers viser serves."""
        self._channel = channel
        self._count_browsers = count_browsers
        self._poses: dict[str, RigidTransform] = {}
        self._numbers: dict[str, int] = {}
        self._moved: set[str] = set()
        self._untold: dict[str, SceneNodeHandle] = {}
        self._askers: list[Browser] = []
        self._moved_s = 0.0
        channel.on(ASKED, self._take_asker, changes=False)

    def move(self, node: SceneNodeHandle, pose: RigidTransform) -> None:
        """Move a node with the next `send`; a node that is new is there at once."""
        name = node.name
        is_new = name not in self._poses
        self._poses[name] = pose
        self._untold[name] = node
        # Also a new one: a browser may remember where an earlier node of this name was.
        self._moved.add(name)
        if is_new:
            self._tell_viser(name)

    def forget(self, node: SceneNodeHandle) -> None:
        """Do not move a node any more: it is removed from the scene."""
        self._poses.pop(node.name, None)
        self._untold.pop(node.name, None)
        self._moved.discard(node.name)

    def send(self, now_s: float) -> None:
        """Send what has moved since the last call."""
        self._askers = [browser for browser in self._askers if browser.is_connected]
        if self._numbers.keys() != self._poses.keys():
            self._number()
        if self._moved:
            self._moved_s = now_s
            if self._askers:
                self._channel.send_bytes(FRAME, self._rows(self._moved))
            self._moved.clear()
        is_missed = self._count_browsers() > len(self._askers)
        if self._untold and (is_missed or now_s - self._moved_s > REST_S):
            for name in tuple(self._untold):
                self._tell_viser(name)

    def _tell_viser(self, name: str) -> None:
        node, pose = self._untold.pop(name), self._poses[name]
        x, y, z, w = pose.rotation
        node.position, node.wxyz = pose.position, (w, x, y, z)

    def _number(self) -> None:
        self._numbers = {name: number for number, name in enumerate(self._poses)}
        self._channel.send(NAMES, {"names": list(self._numbers)}, keep=True)

    def _rows(self, names: set[str]) -> bytes:
        rows = []
        for name in names:
            position, (x, y, z, w) = self._poses[name].position, self._poses[name].rotation
            rows.append(ROW.pack(self._numbers[name], *position, w, x, y, z))
        return b"".join(rows)

    def _take_asker(self, message: Message, browser: Browser) -> None:
        if browser not in self._askers:
            self._askers.append(browser)
        # What moved before it asked was not sent to it.
        self._moved.update(self._poses)
