"""A recording on the page in a real browser, without any simulation: one page for the file."""

import re
import sys

import numpy as np
import pytest
from page_user import DESK, PHONE, PageUser
from programs import Program
from rclpy.serialization import serialize_message
from robots import joint, link, robot
from sensor_msgs.msg import Image, JointState
from std_msgs.msg import String

from arm_cli.bag_format.topic import BagMessage, BagTopic, TypeDefinition
from arm_cli.bag_format.writer import BagSettings, BagWriter
from arm_sim import Simulation

pytestmark = [pytest.mark.ros, pytest.mark.timeout(600)]

LENGTH_S = 20.0
S = 1_000_000_000
URDF = robot(link("base"), link("hand"), joint("j0", "base", "hand"))


@pytest.fixture(scope="module")
def folder(tmp_path_factory):
    """Return a folder with a bag of 20 s, in which joint j0 moves by 0.05 rad/s, and a run.

    The bag has a depth image of 2x2 pixels: 0.5 m and 1 m above 1.5 m and 2 m.
    """
    folder = tmp_path_factory.mktemp("recordings")
    writer = BagWriter(folder / "bag", BagSettings())
    kinds = {
        "/robot_description": "std_msgs/msg/String",
        "/joint_states": "sensor_msgs/msg/JointState",
        "/depth": "sensor_msgs/msg/Image",
    }
    for topic, kind in kinds.items():
        writer.add_topic(BagTopic(topic, kind), TypeDefinition(kind, b""))
    writer.write(BagMessage("/robot_description", 0, 0, serialize_message(String(data=URDF))))
    depth = np.array([[0.5, 1.0], [1.5, 2.0]], dtype=np.float32)
    image = Image(width=2, height=2, encoding="32FC1", step=8, data=depth.tobytes())
    writer.write(BagMessage("/depth", 0, 0, serialize_message(image)))
    for tick in range(round(50 * LENGTH_S) + 1):
        state = JointState(name=["j0"], position=[0.001 * tick])
        writer.write(BagMessage("/joint_states", tick * S // 50, 0, serialize_message(state)))
    writer.close()
    with Simulation("arm", record=folder / "bug.run", arguments={"camera": "none"}) as simulation:
        simulation.run(0.2)
    return folder


@pytest.fixture(scope="module")
def timeline(page_at, folder):
    """Return the page of `arm view`, with the bag open."""
    words = ("view", folder / "bag", "--recordings", folder, "--port", "0")
    viewing = Program([sys.executable, "-m", "arm_cli", *words])
    line = viewing.wait_for_line("the page is at http://")
    yield Timeline(page_at(re.search(r"http://\S+", line)[0]))
    viewing.close()


class Timeline(PageUser):
    """The recording as its user sees it."""

    def __init__(self, page) -> None:
        super().__init__(page)
        self.wait_until(
            lambda: self.value("arm-curve") == '["/joint_states","position[j0]"]', "curve"
        )

    def text(self, name):
        return self.page.locator(f"#{name}").text_content()

    def value(self, name):
        return self.page.evaluate(f"document.getElementById('{name}').value")

    def moment_s(self):
        return float(self.page.locator("#arm-track").get_attribute("aria-valuenow"))

    def joint(self):
        slider = "xpath=//label[.='j0']/following::*[@role='slider'][1]"
        return float(self.page.locator(slider).get_attribute("aria-valuenow"))

    def until_near(self, read, wanted, tolerance):
        assert self.wait_until(lambda: abs(read() - wanted) < tolerance, f"near {wanted}")

    def drag(self, share):
        """Go to a share of the recording with the mouse."""
        place = self.page.locator("#arm-track").bounding_box()
        mouse, y = self.page.mouse, place["y"] + 20
        mouse.move(place["x"] + 20, y)
        mouse.down()
        mouse.move(place["x"] + 10 + share * (place["width"] - 20), y, steps=4)
        mouse.up()


def test_a_recording_says_that_it_is_not_live(timeline):
    banner = timeline.page.get_by_text("RECORDING", exact=True)
    assert banner.is_visible()
    assert "nothing here moves a robot" in timeline.text("arm-banner")
    timeline.wait_until(lambda: timeline.text("arm-state") == "Recording", "the bar says so, too")
    title = timeline.page.locator("#arm-play").get_attribute("title")
    assert title == "This is a recording: go back to live first"


@pytest.mark.parametrize("size", [DESK, PHONE], ids=["desk", "phone"])
def test_the_robot_is_where_the_timeline_is_dragged_to(timeline, size):
    timeline.resize(size)
    try:
        for share in (0.75, 0.25):
            timeline.drag(share)
            timeline.until_near(timeline.moment_s, share * LENGTH_S, 0.5)
            timeline.until_near(timeline.joint, share, 0.03)
    finally:
        timeline.resize(DESK)


def test_a_picture_takes_the_place_of_the_3d_view_and_tells_its_values(timeline):
    canvas = timeline.page.locator("#arm-picture-canvas")
    timeline.click("Full size")
    timeline.wait_until(lambda: "2x2 32FC1" in timeline.text("arm-picture-size"), "a picture")
    assert timeline.text("arm-picture-scale") == "0.50 m2.00 m"
    place = canvas.bounding_box()
    x, y = (place[start] + 0.5 * place[size] for start, size in (("x", "width"), ("y", "height")))
    for by, value in ((-20, "0.500 m at 0, 0"), (20, "2.000 m at 1, 1")):
        timeline.page.mouse.move(x + by, y + by)
        timeline.wait_until(
            lambda value=value: timeline.text("arm-picture-value") == value, f"{value} is told"
        )
    timeline.click("Back to the 3D view")
    canvas.wait_for(state="hidden")


def test_space_plays_and_the_end_is_the_end(timeline):
    timeline.page.keyboard.press("End")
    timeline.drag(0.9)
    timeline.page.locator("#arm-deck-speed").select_option("10")
    timeline.page.keyboard.press("Space")
    timeline.until_near(timeline.moment_s, LENGTH_S, 0.001)
    timeline.until_near(timeline.joint, 1.0, 0.002)
    timeline.page.locator("#arm-deck-play[aria-label=Play]").wait_for()


def test_a_mark_is_kept_beside_the_bag(timeline, folder):
    timeline.drag(0.5)
    timeline.page.keyboard.press("m")
    timeline.page.locator("#arm-mark-text").fill("half way")
    timeline.page.locator("#arm-mark-text").press("Enter")
    file = folder / "bag" / "marks.json"
    assert timeline.wait_until(lambda: file.exists() and "half way" in file.read_text(), "the file")


def test_back_to_live_and_from_the_list_into_the_recording(timeline):
    timeline.click("Back to live")
    timeline.page.locator("#arm-timeline").wait_for(state="hidden")
    timeline.wait_until(lambda: timeline.text("arm-state") != "Recording", "live")
    timeline.click("Recordings")
    timeline.click("Open bag")
    timeline.page.locator("#arm-timeline").wait_for(state="visible")
    timeline.until_near(timeline.moment_s, 0.0, 0.001)


def test_a_run_is_verified_and_then_shown(timeline):
    timeline.click("Recordings")
    timeline.click("Open bug.run")
    timeline.wait_until(lambda: timeline.text("arm-run").startswith("✓ verified: all 20"), "equal")
    timeline.page.locator("#arm-timeline").wait_for(state="visible")
    assert timeline.text("arm-banner-kind") == "RECORDED RUN"
    timeline.drag(0.5)
    timeline.until_near(timeline.moment_s, 0.1, 0.02)
    timeline.click("Back to live")
    timeline.page.locator("#arm-timeline").wait_for(state="hidden")


def test_the_page_records_a_bag_that_it_opens(timeline, folder):
    page = timeline.page
    timeline.click("Recordings")
    page.locator("#arm-topics").fill("/rosout")
    timeline.click("Record")
    timeline.wait_until(lambda: "nothing dropped" in timeline.text("arm-recorder"), "it records")
    timeline.click("Stop")
    timeline.wait_until(lambda: "messages of" in timeline.text("arm-recorder"), "it has stopped")
    made = [path for path in folder.iterdir() if path.name.startswith("recording_")]
    assert [path.suffix for path in made[0].iterdir() if path.suffix == ".mcap"] == [".mcap"]
    page.get_by_role("button", name=f"Open {made[0].name}").wait_for()
