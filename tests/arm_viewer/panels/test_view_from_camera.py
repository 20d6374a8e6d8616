"""A browser that looks from a camera is told its pose, once for each change."""

from types import SimpleNamespace

import pytest
from fake_channel import FakeBrowser, FakeChannel

from arm_node.rigid_transform import RigidTransform
from arm_viewer.panels.view_from_camera import ViewFromCamera, camera_of
from arm_viewer.snapshot import CameraView, Snapshot

SIDE = CameraView("side_optical", 320, 240, (160.0, 160.0), (160.0, 120.0))
WIDE = CameraView("side_optical", 320, 240, (80.0, 80.0), (160.0, 100.0))
ONE_UP = RigidTransform((0.0, 0.0, 1.0))
# The optical axis z is the world's x, and the image's upper edge is up.
AHEAD = RigidTransform((0.0, 0.0, 1.0), (-0.5, 0.5, -0.5, 0.5))


class Page:
    """The panel, the poses of its frames, and a browser."""

    def __init__(self):
        self.channel, self.browser = FakeChannel(), FakeBrowser()
        self.known = {"side_optical": AHEAD}
        self.panel = ViewFromCamera(self.channel, SimpleNamespace(known=self.known))
        self.panel.build(None)
        assert not self.channel.changing

    def ask(self, topic):
        self.channel.take("view_from", self.browser, topic=topic)

    def update(self, view=SIDE):
        self.panel.update(Snapshot(cameras={"/side/camera_info": view}))
        assert {kind for kind, _ in self.browser.sent} <= {"view_from_pose"}
        return self.browser.told


@pytest.fixture
def page():
    return Page()


def test_nobody_is_told_what_nobody_asked_for(page):
    assert page.update() == []


def test_the_view_is_where_the_camera_is_and_as_wide(page):
    page.ask("/side/image_raw")
    (told,) = page.update()
    assert told["position"] == (0.0, 0.0, 1.0)
    assert told["target"] == pytest.approx((0.5, 0.0, 1.0))
    assert told["up"] == pytest.approx((0.0, 0.0, 1.0))
    assert told["half"] == (1.0, 0.75)
    assert told["problem"] == ""


def test_the_view_follows_and_what_has_not_changed_is_not_told_again(page):
    page.ask("/side/image_raw")
    page.update()
    page.update()
    assert len(page.browser.told) == 1
    page.known["side_optical"] = ONE_UP
    page.update()
    page.update(WIDE)
    assert page.browser.told[1]["target"] == pytest.approx((0.0, 0.0, 1.5))
    assert page.browser.told[2]["half"] == (2.0, 1.75), "all of the picture, also off its centre"
    page.ask("")
    page.known["side_optical"] = AHEAD
    assert len(page.update()) == 3


def test_what_is_missing_is_said(page):
    page.ask("/other/image_raw")
    assert "No CameraInfo" in page.update()[-1]["problem"]
    page.ask("/side/image_raw")
    page.known.clear()
    assert page.update()[-1]["problem"] == "No transform on /tf for side_optical"


def test_a_browser_that_has_left_is_told_nothing(page):
    page.ask("/side/image_raw")
    page.browser.is_connected = False
    assert page.update() == []


@pytest.mark.parametrize("info", ["/a/camera_info", "/a/image/camera_info"])
def test_the_camera_info_is_beside_the_image_or_below_it(info):
    assert camera_of("/a/image", {info: SIDE, "/b/camera_info": WIDE}) is SIDE
    assert camera_of("/image", {info: SIDE}) is None
