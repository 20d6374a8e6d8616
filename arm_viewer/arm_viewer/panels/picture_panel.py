"""A picture at its full size in place of the 3D view, with the values of its pixels.

It is part of the served page (`front/picture.*`). A browser asks for one picture after the other,
so one that is slow gets fewer, and each sees the topic that it chose.
"""

import time
from dataclasses import dataclass

import cv2
from viser import GuiApi

from arm_viewer.channel import Browser, Channel, Message
from arm_viewer.errors import PictureError
from arm_viewer.picture_pixels import colours, depth_range, depth_scale, value_at
from arm_viewer.snapshot import Picture, Snapshot

TOPICS, NEXT, ABOUT, VALUE = "picture_topics", "picture_next", "picture_about", "picture_value"
"""Kinds of messages: the image topics; the wish for the next picture; what the next frame shows;
the value of a pixel, asked and answered."""
FRAME = 3
"""The kind of the binary frames: a JPEG."""
JPEG_QUALITY = 85
ASKED_S = 3.0
"""A browser that shows pictures asks more often than this."""


@dataclass(slots=True)
class _Viewing:
    """What a browser looks at: the topic, when it asked last, and what it has got."""

    topic: str
    asked_s: float
    is_waiting: bool = True
    shown: Picture | None = None


class PicturePanel:
    """Sends each browser the pictures that it asks for."""

    def __init__(self, channel: Channel) -> None:
        """Use the page's channel."""
        self._channel = channel
        self._viewing: dict[Browser, _Viewing] = {}
        self._topics: tuple[str, ...] | None = None
        self._snapshot = Snapshot()

    def build(self, gui: GuiApi) -> None:
        """Serve the browsers."""
        self._channel.on(NEXT, self._take_wish, changes=False)
        self._channel.on(VALUE, self._take_place, changes=False)

    def wanted(self) -> frozenset[str]:
        """Return the topics that browsers look at."""
        return frozenset(viewing.topic for viewing in self._viewing.values())

    def update(self, snapshot: Snapshot) -> None:
        """Send what is new to those who wait for it."""
        self._snapshot = snapshot
        if snapshot.image_topics != self._topics:
            self._topics = snapshot.image_topics
            fields = {"topics": list(self._topics), "scale": depth_scale()}
            self._channel.send(TOPICS, fields, keep=True)
        oldest_s = time.monotonic() - ASKED_S
        for browser, viewing in list(self._viewing.items()):
            picture = snapshot.pictures.get(viewing.topic)
            if viewing.asked_s < oldest_s:
                del self._viewing[browser]
            elif (
                viewing.is_waiting
                and picture is not None
                and picture is not viewing.shown
                and _sent(browser, viewing.topic, picture)
            ):
                viewing.is_waiting, viewing.shown = False, picture

    def _take_wish(self, message: Message, browser: Browser) -> None:
        topic, is_first = message.text("topic"), message.flag("first")
        viewing = self._viewing.get(browser)
        if viewing is None or is_first or viewing.topic != topic:
            viewing = self._viewing[browser] = _Viewing(topic, 0.0)
        viewing.is_waiting, viewing.asked_s = True, time.monotonic()

    def _take_place(self, message: Message, browser: Browser) -> None:
        topic = message.text("topic")
        column, row = message.number("column"), message.number("row")
        picture = self._snapshot.pictures.get(topic)
        try:
            text = "" if picture is None else value_at(picture, int(column), int(row))
        except PictureError as error:
            text = str(error)
        browser.send(VALUE, {"column": column, "row": row, "text": text})


def _sent(browser: Browser, topic: str, picture: Picture) -> bool:
    """Send a picture; return whether the browser has taken it."""
    about: dict[str, object] = {
        "topic": topic,
        "width": picture.width,
        "height": picture.height,
        "encoding": picture.encoding,
        "range_m": None,
        "problem": "",
    }
    try:
        about["range_m"] = depth_range(picture)
        pixels = cv2.cvtColor(colours(picture), cv2.COLOR_RGB2BGR)
    except PictureError as error:
        browser.send(ABOUT, {**about, "problem": str(error)})
        return True
    _, jpeg = cv2.imencode(".jpg", pixels, (cv2.IMWRITE_JPEG_QUALITY, JPEG_QUALITY))
    browser.send(ABOUT, about)
    return browser.send_bytes(FRAME, jpeg.tobytes())
