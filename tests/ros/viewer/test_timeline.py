"""A recording on the page in a real browser, without any simulation: one page for the file."""

import re
import sys

import numpy as np
import pytest
from altered_run import write_altered_run
from page_user import DESK, KEEP_WHAT_IS_SAID, PHONE, PageUser
from programs import Program
from rclpy.serialization import serialize_message
from robots import joint, link, robot
from sensor_msgs.msg import Image, JointState
from std_msgs.msg import String

from arm_cli.bag_format.topic import BagMessage, BagTopic, TypeDefinition
from arm_cli.bag_format.writer import BagSettings, BagWriter
from arm_gazebo.ros.contact_markers import contact_markers
from arm_gazebo.world.contacts import Contact
from arm_sim import Simulation

pytestmark = pytest.mark.timeout(600)

LENGTH_S = 20.0
LONG_S = 150.0
KEEP_VERDICTS = """
  window.verdicts = [];
  addEventListener("DOMContentLoaded", () => {
    const verdict = document.getElementById("arm-run");
    new MutationObserver(() => {
      const place = document.getElementById("arm-track").getBoundingClientRect();
      window.verdicts.push([verdict.textContent, place.width > 0]);
    }).observe(verdict, { childList: true, characterData: true, subtree: true });
  });
"""
"""A script before those of the page: it keeps what was said of a run, and whether it was shown."""
S = 1_000_000_000
HERE, UP = np.array([0.5, 0.0, 0.0]), np.array([0.0, 0.0, 1.0])
CONTACT = Contact("hand", "world", HERE, UP, 0.0, 5.0 * UP)
URDF = robot(link("base"), link("hand"), joint("j0", "base", "hand"))


@pytest.fixture(scope="module")
def folder(tmp_path_factory):
    """Return a folder with a bag of 20 s, in which joint j0 moves by 0.05 rad/s, and with runs.

    The bag has a depth image of 2x2 pixels: 0.5 m and 1 m above 1.5 m and 2 m. Its contacts are one
    until 10 s, and none from then on.
    """
    folder = tmp_path_factory.mktemp("recordings")
    writer = BagWriter(folder / "bag", BagSettings())
    kinds = {
        "/robot_description": "std_msgs/msg/String",
        "/joint_states": "sensor_msgs/msg/JointState",
        "/depth": "sensor_msgs/msg/Image",
        "/contact_markers": "visualization_msgs/msg/MarkerArray",
    }
    for topic, kind in kinds.items():
        writer.add_topic(BagTopic(topic, kind), TypeDefinition(kind, b""))
    writer.write(BagMessage("/robot_description", 0, 0, serialize_message(String(data=URDF))))
    depth = np.array([[0.5, 1.0], [1.5, 2.0]], dtype=np.float32)
    image = Image(width=2, height=2, encoding="32FC1", step=8, data=depth.tobytes())
    writer.write(BagMessage("/depth", 0, 0, serialize_message(image)))
    for time_ns, contacts in ((0, [CONTACT]), (10 * S, [])):
        data = serialize_message(contact_markers(contacts))
        writer.write(BagMessage("/contact_markers", time_ns, time_ns, data))
    for tick in range(round(50 * LENGTH_S) + 1):
        state = JointState(name=["j0"], position=[0.001 * tick])
        writer.write(BagMessage("/joint_states", tick * S // 50, 0, serialize_message(state)))
    writer.close()
    with Simulation("arm", record=folder / "bug.run", arguments={"camera": "none"}) as simulation:
        simulation.run(0.2)
    write_altered_run(folder / "bug.run", folder / "altered.run", 12, "position of joint j1", 0.5)
    content = (folder / "bug.run").read_bytes()
    (folder / "broken.run").write_bytes(content[:200] + bytes(100) + content[300:])
    with Simulation("arm", record=folder / "long.run", arguments={"camera": "none"}) as simulation:
        simulation["position_controller"].command([0.4, 0.3, 0.2, 0.1])
        simulation.run(LONG_S)
    return folder


@pytest.fixture(scope="module")
def new_timeline(page_at, folder):
    """Return a function that opens the page of `arm view`, with the bag, in a window of a size."""
    words = ("view", folder / "bag", "--recordings", folder, "--port", "0")
    viewing = Program([sys.executable, "-m", "arm_cli", *words])
    line = viewing.wait_for_line("the page is at http://")
    url, script = re.search(r"http://\S+", line)[0], KEEP_WHAT_IS_SAID + KEEP_VERDICTS
    yield lambda size: Timeline(page_at(url, script, size))
    viewing.close()


@pytest.fixture(scope="module")
def timeline(new_timeline):
    """Return a page as it is on a desk."""
    return new_timeline(DESK)


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

    def open(self, name):
        self.page.evaluate("window.verdicts.length = 0")
        self.click("Recordings")
        self.click(f"Open {name}")

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
            assert timeline.joint() == pytest.approx(share, abs=0.03)
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


@pytest.mark.parametrize("size", [DESK, PHONE], ids=["desk", "phone"])
def test_recorded_contacts_are_drawn_like_live_ones(new_timeline, size):
    timeline = new_timeline(size)
    timeline.drag(0.25)
    timeline.switch("Contacts", True)
    timeline.page.get_by_text("hand on world: 5 N").wait_for(state="attached")
    timeline.wait_until(lambda: timeline.contacts() == [[0.5, 0, 0]], "the point is drawn")
    assert timeline.forces() == [pytest.approx([0.5, 0, 0, 0.5, 0, 0.1])], "2 cm a newton"
    timeline.drag(0.75)
    timeline.page.get_by_text("Nothing touches").wait_for(state="attached")
    timeline.wait_until(lambda: timeline.contacts() == [], "the point has gone")
    timeline.drag(0.25)
    timeline.wait_until(lambda: timeline.contacts() == [[0.5, 0, 0]], "it is back")
    timeline.switch("Contacts", False)
    timeline.wait_until(lambda: timeline.contacts() == [], "it is not shown any more")
    assert "nothing here moves a robot" in timeline.text("arm-banner"), "nothing was refused"
    timeline.page.close()


def test_space_plays_and_the_end_is_the_end(timeline):
    timeline.page.keyboard.press("End")
    timeline.drag(0.9)
    timeline.page.locator("#arm-deck-speed").select_option("10")
    timeline.page.keyboard.press("Space")
    timeline.until_near(timeline.moment_s, LENGTH_S, 0.001)
    timeline.until_near(timeline.joint, 1.0, 0.002)
    timeline.page.locator("#arm-deck-play[aria-label=Play]").wait_for()
    assert timeline.joint() == pytest.approx(1.0, abs=0.002)


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
    assert timeline.moment_s() == pytest.approx(0.0, abs=0.001)


@pytest.mark.parametrize("size", [DESK, PHONE], ids=["desk", "phone"])
def test_a_good_run_is_equal_to_its_end(timeline, size):
    timeline.resize(size)
    try:
        timeline.open("bug.run")
        timeline.wait_until(
            lambda: timeline.text("arm-run") == "✓ verified: all 20 control periods are equal",
            "equal",
        )
        timeline.page.locator("#arm-timeline").wait_for(state="visible")
        assert timeline.text("arm-banner-kind") == "RECORDED RUN"
        timeline.wait_until(lambda: timeline.is_whole("arm-verdict"), "the verdict is whole")
        timeline.drag(0.5)
        timeline.until_near(timeline.moment_s, 0.1, 0.02)
        timeline.click("Back to live")
        timeline.page.locator("#arm-timeline").wait_for(state="hidden")
        assert timeline.text("arm-stopped") == ""
    finally:
        timeline.resize(DESK)


@pytest.mark.parametrize("size", [DESK, PHONE], ids=["desk", "phone"])
def test_a_run_with_another_recorded_number_says_where_it_differs(timeline, size):
    timeline.resize(size)
    try:
        timeline.open("altered.run")
        timeline.wait_until(lambda: timeline.text("arm-run").startswith("≠ differs"), "differs")
        timeline.page.locator("#arm-timeline").wait_for(state="visible")
        said = timeline.text("arm-run")
        found = re.match(
            r"≠ differs at 0\.13 s, in control period 12: position of joint j1: (\S+) instead of "
            r"(\S+), by -0\.5$",
            said,
        )
        assert found, said
        assert float(found[2]) - float(found[1]) == pytest.approx(0.5)
        assert timeline.is_whole("arm-mark")
        # What is beyond the difference was not compared, and is not shown.
        timeline.drag(0.95)
        timeline.until_near(timeline.moment_s, 0.12, 1e-6)
        timeline.page.locator("#arm-verdict").click()
        menu = timeline.page.locator("#arm-run-menu")
        menu.get_by_text("0 to 0.12 of 0.20 s is equal").wait_for()
        assert timeline.is_whole("arm-run-menu")
        assert timeline.text("arm-run-differences") == said.split(": ", 1)[1]
        timeline.drag(0.1)
        timeline.page.locator("#arm-verdict").click()
        timeline.click("Go to the last equal moment")
        timeline.until_near(timeline.moment_s, 0.12, 1e-6)
    finally:
        timeline.click("Back to live")
        timeline.page.locator("#arm-timeline").wait_for(state="hidden")
        timeline.resize(DESK)


def test_a_run_plays_while_it_is_verified_and_only_what_is_equal_is_shown(timeline):
    timeline.open("long.run")
    timeline.page.locator("#arm-timeline").wait_for(state="visible")
    timeline.page.locator("#arm-deck-speed").select_option("10")
    timeline.page.locator("#arm-deck-play").click()
    timeline.wait_until(lambda: timeline.moment_s() > 1.0, "it plays")
    timeline.wait_until(lambda: timeline.text("arm-run").startswith("✓ verified: all 15000"), "end")
    verdicts = timeline.page.evaluate("window.verdicts")
    meanwhile = [text for text, is_shown in verdicts if is_shown and text.startswith("…")]
    equal = re.compile(r"… equal so far: (\S+) of 150.00 s")
    compared_s = [float(found[1]) for found in map(equal.fullmatch, meanwhile) if found]
    assert len(compared_s) == len(meanwhile) > 0, verdicts
    assert compared_s == sorted(compared_s)
    assert compared_s[-1] < LONG_S
    timeline.page.locator("#arm-track").press("End")
    timeline.until_near(timeline.moment_s, LONG_S, 0.001)
    timeline.click("Back to live")
    timeline.page.locator("#arm-timeline").wait_for(state="hidden")


def test_a_verification_that_is_left_says_what_it_did_not_compare(timeline):
    timeline.open("long.run")
    timeline.page.locator("#arm-timeline").wait_for(state="visible")
    timeline.wait_until(lambda: timeline.text("arm-run").startswith("… equal so far"), "equal")
    timeline.click("Back to live")
    said = timeline.says("verification stopped")
    found = re.fullmatch(
        r"long\.run: verification stopped; 0 to (\S+) of 150\.00 s is equal, the rest was not "
        r"compared",
        said,
    )
    assert found, said
    assert 0.0 < float(found[1]) < LONG_S
    assert timeline.text("arm-stopped") == said
    timeline.page.locator("#arm-timeline").wait_for(state="hidden")


def test_a_damaged_run_is_told_in_a_sentence_and_the_page_stays_live(timeline):
    timeline.open("broken.run")
    timeline.wait_until(lambda: "cannot be run again" in timeline.text("arm-banner"), "a sentence")
    assert "broken.run is damaged" in timeline.text("arm-banner")
    assert "the page is live" in timeline.text("arm-banner")
    assert not timeline.page.locator("#arm-timeline").is_visible()
    timeline.click("Close")
    timeline.page.locator("#arm-banner").wait_for(state="hidden")


def test_the_page_records_a_bag_that_it_opens(timeline, folder):
    page = timeline.page
    timeline.click("Recordings")
    page.locator("#arm-topics").fill("/rosout")
    timeline.click("Record")
    timeline.wait_until(lambda: "nothing dropped" in timeline.text("arm-recorder"), "it records")
    assert not page.locator("#arm-run-button").is_visible(), "one recording at a time"
    timeline.click("Stop")
    timeline.wait_until(lambda: "messages of" in timeline.text("arm-recorder"), "it has stopped")
    made = [path for path in folder.iterdir() if path.name.startswith("recording_")]
    assert [path.suffix for path in made[0].iterdir() if path.suffix == ".mcap"] == [".mcap"]
    page.get_by_role("button", name=f"Open {made[0].name}").wait_for()
