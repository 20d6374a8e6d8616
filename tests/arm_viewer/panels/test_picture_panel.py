"""Pictures at full size: each browser gets the newest one when it asks for it."""

from types import MappingProxyType

import cv2
import numpy as np
import pytest
from fake_channel import FakeBrowser, FakeChannel

from arm_viewer.panels import picture_panel
from arm_viewer.panels.picture_panel import PicturePanel
from arm_viewer.snapshot import Picture, Snapshot

COLOUR = Picture("rgb8", 2, 1, 6, False, np.array([255, 0, 0, 0, 0, 255], dtype=np.uint8))
DEPTH = Picture("32FC1", 2, 1, 8, False, np.array([0.5, 2.0], np.float32).view(np.uint8))
ODD = Picture("yuv422", 2, 1, 4, False, np.zeros(4, np.uint8))


class Page:
    """The panel with a browser."""

    def __init__(self):
        self.channel, self.browser = FakeChannel(), FakeBrowser()
        self.panel = PicturePanel(self.channel)
        self.panel.build(None)
        assert not self.channel.changing

    def ask(self, topic="/colour", first=False):
        self.channel.take("picture_next", self.browser, topic=topic, first=first)

    def value(self, topic, column, row=0):
        self.channel.take("picture_value", self.browser, topic=topic, column=column, row=row)
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
    page.browser.keeps_up = False
    page.ask()
    page.show(colour=COLOUR)
    page.browser.keeps_up = True
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
