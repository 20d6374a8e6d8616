"""What nodes say, diagnose, publish and transform: the other parts of the page's dock.

The parts themselves are in the served page (`front/observe.js`). A browser names the part that it
shows, and gets that alone: at once, and then what is new.
"""

import math
import time
from collections.abc import Mapping
from dataclasses import dataclass
from typing import Any

from viser import GuiApi

from arm_viewer.channel import Browser, Channel, Message
from arm_viewer.errors import BrowserMessageError
from arm_viewer.requests import MeasureRates, Send
from arm_viewer.scene.frames import frame_poses
from arm_viewer.snapshot import ComponentStatus, LogEntry, Snapshot, Topic, Transform

SHOW = "show_part"
"""A browser's message: which part it shows, and what it wants to know there."""
LOG, DIAGNOSTICS, TOPICS, FRAMES = PARTS = ("log", "diagnostics", "topics", "frames")
PERIOD_S = 0.2
STALE_S = 5.0
"""A status that was not renewed for this long is stale."""
MAX_ENTRIES = 500
"""Log entries in one message."""


@dataclass(slots=True)
class _Sight:
    """What a browser sees.

    Attributes:
        part: one of PARTS, or empty.
        measures: whether it wants rates.
        frame: the frame whose pose it wants.
        within: the frame in which it wants the pose.
        told: the last message, or the number of the last log entry.
    """

    part: str
    measures: bool
    frame: str
    within: str
    told: Any = None


class Observations:
    """Serves the parts that browsers show."""

    def __init__(self, channel: Channel, send: Send) -> None:
        """Use the page's channel; send requests with `send`."""
        self._channel = channel
        self._send = send
        self._sights: dict[Browser, _Sight] = {}
        self._is_measured = False
        self._sent_s = -math.inf

    def build(self, gui: GuiApi) -> None:
        """Serve the browsers' messages."""
        self._channel.on(SHOW, self._take_sight, changes=False)

    def update(self, snapshot: Snapshot) -> None:
        """Send what is new and due."""
        now_s = time.monotonic()
        if now_s - self._sent_s < PERIOD_S:
            return
        self._sent_s = now_s
        self._sights = {b: sight for b, sight in self._sights.items() if b.is_connected}
        is_wanted = any(sight.part == TOPICS and sight.measures for sight in self._sights.values())
        if is_wanted != self._is_measured:
            self._is_measured = is_wanted
            self._send(MeasureRates(is_wanted))
        for browser, sight in self._sights.items():
            if sight.part == LOG:
                _send_log(browser, sight, snapshot.log)
            elif sight.part:
                fields = _fields(sight, snapshot, now_s)
                if fields != sight.told:
                    sight.told = fields
                    browser.send(sight.part, fields)

    def _take_sight(self, message: Message, browser: Browser) -> None:
        part = message.text("part")
        if part and part not in PARTS:
            raise BrowserMessageError(f"there is no part '{part}'; there are {', '.join(PARTS)}")
        self._sights[browser] = _Sight(
            part, message.flag("measures"), message.text("frame"), message.text("within")
        )


def _send_log(browser: Browser, sight: _Sight, entries: tuple[LogEntry, ...]) -> None:
    """Send the entries that follow the last one that was sent."""
    last = entries[-1].number if entries else 0
    if last != sight.told:
        is_first = sight.told is None
        new = entries[-(last - (sight.told or 0)) :] if entries else ()
        sight.told = last
        for begin in range(0, max(1, len(new)), MAX_ENTRIES):
            rows = [
                [round(e.time_s, 3), e.level, e.node, e.text, e.place]
                for e in new[begin : begin + MAX_ENTRIES]
            ]
            browser.send(LOG, {"entries": rows, "restarts": is_first and begin == 0})


def _fields(sight: _Sight, snapshot: Snapshot, now_s: float) -> dict[str, Any]:
    if sight.part == DIAGNOSTICS:
        return {"components": diagnostic_rows(snapshot.diagnoses, now_s)}
    if sight.part == TOPICS:
        return {"topics": [_topic_row(topic) for topic in snapshot.topics]}
    return {
        "frames": [[name, t.parent] for name, t in sorted(snapshot.transforms.items())],
        "pose": pose_fields(snapshot.transforms, sight.frame, sight.within),
    }


def diagnostic_rows(diagnoses: Mapping[str, ComponentStatus], now_s: float) -> list[list[Any]]:
    """Return name, level, text, hardware and values of each component, by name."""
    return [
        [name, 3 if now_s - d.received_s > STALE_S else d.level, d.text, d.hardware, d.values]
        for name, d in sorted(diagnoses.items())
    ]


def _topic_row(topic: Topic) -> list[Any]:
    measured = [
        None if math.isnan(value) else round(value, digits)
        for value, digits in ((topic.rate_hz, 1), (topic.bytes_per_s, 0), (topic.delay_s, 4))
    ]
    return [topic.name, ", ".join(topic.types), topic.publishers, topic.subscriptions, *measured]


def pose_fields(
    transforms: Mapping[str, Transform], frame: str, within: str
) -> dict[str, Any] | None:
    """Return the pose of a frame in another; None without a frame.

    Returns:
        Position in m, rotation as roll, pitch and yaw in rad and as a quaternion (x, y, z, w), and
        a sentence if there is no such pose.
    """
    if not frame:
        return None
    poses = frame_poses(transforms)
    roots = {name: _root(name, transforms) for name in (frame, within)}
    missing = [name for name in (frame, within) if name not in poses]
    if missing:
        return {"problem": f"There is no transform of '{missing[0]}' at present."}
    if roots[frame] != roots[within]:
        return {
            "problem": f"'{frame}' and '{within}' are in different trees, below "
            f"'{roots[frame]}' and '{roots[within]}'."
        }
    pose = poses[within].inverse().then(poses[frame])
    return {
        "problem": "",
        "position": [round(value, 5) for value in pose.position],
        "rpy": [round(value, 5) for value in pose.rpy()],
        "quaternion": [round(value, 5) for value in pose.rotation],
    }


def _root(frame: str, transforms: Mapping[str, Transform]) -> str:
    """Return the frame above all others, or the frame itself in a loop."""
    seen: set[str] = set()
    at = frame
    while at in transforms and at not in seen:
        seen.add(at)
        at = transforms[at].parent
    return frame if at in seen else at
