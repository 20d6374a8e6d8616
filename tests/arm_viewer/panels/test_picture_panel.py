"""Pictures at full size: each browser gets the newest one when it asks for it."""

from types import MappingProxyType

import cv2
import numpy as np
import pytest

from arm_viewer.channel import Message
from arm_viewer.panels import picture_panel
from arm_viewer.panels.picture_panel import PicturePanel
from arm_viewer.snapshot import Picture, Snapshot

COLOUR = Picture("rgb8", 2, 1, 6, False, np.array([255, 0, 0, 0, 0, 255], dtype=np.uint8))
DEPTH = Picture("32FC1", 2, 1, 8, False, np.array([0.5, 2.0], np.float32).view(np.uint8))
ODD = Picture("yuv422", 2, 1, 4, False, np.zeros(4, np.uint8))


class FakeChannel:
    """Keeps what goes to every browser, and takes messages as a browser's."""

    def __init__(self):
        self.kept = {}
        self.handlers = {}

    def on(self, kind, handler, *, changes=True):
        assert not changes
        self.handlers[kind] = handler

    def send(self, kind, fields, *, keep):
        self.kept[kind] = fields


class FakeBrowser:
    """Keeps what it is sent; a slow one takes no frame."""

    def __init__(self):
        self.told, self.frames, self.is_slow = [], [], False

    def send(self, kind, fields):
        self.told.append(fields)

    def send_bytes(self, kind, payload):
        if not self.is_slow:
            self.frames.append(payload)
        return not self.is_slow


class Page:
    """The panel with a browser."""

    def __init__(self):
        self.channel, self.browser = FakeChannel(), FakeBrowser()
        self.panel = PicturePanel(self.channel)
        self.panel.build(None)

    def ask(self, topic="/colour", first=False):
        message = Message("picture_next", {"topic": topic, "first": first})
        self.channel.handlers["picture_next"](message, self.browser)

    def value(self, topic, column, row=0):
        message = Message("picture_value", {"topic": topic, "column": column, "row": row})
        self.channel.handlers["picture_value"](message, self.browser)
        return self.browser.told[-1]["text"]

    def show(self, **pictures):
        shown = {f"/{topic}": picture for topic, picture in pictures.items()}
        topics = ("/colour", "/depth")
        self.panel.update(Snapshot(image_topics=topics, pictures=MappingProxyType(shown)))


@pytest.fixture
def page():
    return Page()


def test_every_browser_learns_the_topics_and_the_scale(page):
    page.show()
    assert page.channel.kept["picture_topics"]["topics"] == ["/colour", "/depth"]
    assert len(page.channel.kept["picture_topics"]["scale"]) > 2


def test_a_picture_comes_once_for_each_wish(page):
    page.ask()
    assert page.panel.wanted() == {"/colour"}
    page.show(colour=COLOUR, depth=DEPTH)
    page.show(colour=ODD)
    assert len(page.browser.frames) == 1
    shown = cv2.imdecode(np.frombuffer(page.browser.frames[0], np.uint8), cv2.IMREAD_COLOR)
    assert shown.shape == (1, 2, 3)
    page.show(colour=COLOUR)
    page.ask()
    page.show(colour=COLOUR)
    assert len(page.browser.frames) == 1, "the same picture is not sent twice"
    page.ask(first=True)
    page.show(colour=COLOUR)
    assert len(page.browser.frames) == 2


def test_depth_comes_with_its_range(page):
    page.ask("/depth")
    page.show(depth=DEPTH)
    assert page.browser.told[0]["range_m"] == (0.5, 2.0)
    assert page.value("/depth", 1) == "2.000 m"
    assert page.value("/gone", 1) == ""


def test_a_slow_browser_gets_the_newest_picture_later(page):
    page.browser.is_slow = True
    page.ask()
    page.show(colour=COLOUR)
    page.browser.is_slow = False
    page.show(colour=COLOUR)
    assert len(page.browser.frames) == 1


def test_what_cannot_be_shown_says_why(page):
    page.ask()
    page.show(colour=ODD)
    assert "yuv422" in page.browser.told[0]["problem"]
    assert "yuv422" in page.value("/colour", 0)
    assert page.browser.frames == []


def test_a_browser_that_asks_no_more_is_forgotten(page, monkeypatch):
    page.ask()
    now_s = picture_panel.time.monotonic() + picture_panel.ASKED_S + 1.0
    monkeypatch.setattr(picture_panel.time, "monotonic", lambda: now_s)
    page.show(colour=COLOUR)
    assert page.panel.wanted() == frozenset()
    assert page.browser.frames == []
