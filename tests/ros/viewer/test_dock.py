"""The dock below the page in a real browser, beside a real launch: one for the file."""

import itertools
import re

import pytest
from page_user import DESK, PHONE, PageUser
from sensor_msgs.msg import JointState
from std_msgs.msg import Float64MultiArray

pytestmark = pytest.mark.timeout(600)

CAMERA = "none"
SIZES = {"desk": DESK, "phone": PHONE}
LEFT_BUTTON = {"isPrimary": True, "pointerId": 1, "button": 0}
DRAWN = """(canvas) => {
  const { data } = canvas.getContext("2d").getImageData(0, 0, canvas.width, canvas.height);
  return data.some((value) => value > 0);
}"""
KEEPS_PEAKS = """() => {
  const store = new ArmCurveStore(64);
  for (let k = 0; k < 5000; k += 1) {
    store.push(k, k === 777 ? NaN : k === 1234 ? 9 : k === 3000 ? -9 : Math.sin(k));
  }
  const kept = [...store.values.slice(0, store.length)];
  const times = [...store.times.slice(0, store.length)];
  const gap = times.findIndex((time, k) => Number.isNaN(kept[k]));
  return { kept: kept.filter((value) => !Number.isNaN(value)), gap: times[gap], times };
}"""


@pytest.fixture(scope="module")
def page(page_at, simulation, page_url):
    """Return the page of a browser."""
    opened = page_at(page_url)
    opened.get_by_role("tab", name="Plots", exact=True).wait_for()
    return opened


class Dock(PageUser):
    """The dock as its user sees it."""

    def open(self, name):
        """Open a tab of the dock; return its panel."""
        tab = self.page.get_by_role("tab", name=name, exact=True)
        if tab.get_attribute("aria-selected") != "true":
            tab.dispatch_event("click")
        panel = self.page.locator(f"[role=tabpanel][aria-labelledby='arm-tab-{name}']")
        panel.wait_for()
        return panel

    def panel(self, title):
        """Return a panel of the plots."""
        return self.page.locator("figure", has=self.page.locator(f"b:text-is('{title}')"))

    def value(self, panel, label):
        """Return the number beside a curve's name; NaN while there is none."""
        chip = self.panel(panel).locator(f".arm-chip:has(span:text-is('{label}')) output")
        found = re.fullmatch(r"[\u2212\d.]+", chip.inner_text())
        return float(found[0].replace("\u2212", "-")) if found else float("nan")


@pytest.fixture
def dock(page):
    """Return the dock of a desktop's window."""
    return dock_in(page, DESK)


def dock_in(page, size):
    """Return the dock of a window of a size; plots are those that there are at first."""
    dock = Dock(page)
    dock.resize(size)
    dock.open("Plots")
    dock.click("Show position, velocity and effort of all joints")
    dock.panel("Position").wait_for()
    return dock


@pytest.fixture
def command(client_for_file):
    """Send positions to the controller, by a function; a message may be lost, so send it again."""
    publisher = client_for_file.publisher(Float64MultiArray, "/position_controller/commands")
    return lambda values: publisher.publish(Float64MultiArray(data=values))


@pytest.mark.parametrize("size", SIZES.values(), ids=SIZES)
def test_joints_are_plotted_at_once_and_follow_their_commands(page, command, size):
    dock = dock_in(page, size)
    goals = itertools.cycle([0.5, -0.5])
    goal = next(goals)

    def arrived():
        command([goal, 0.0, 0.0, 0.0])
        return abs(dock.value("Position", "j0") - goal) < 0.01

    dock.wait_until(arrived, "the curve of j0 arrives")
    dock.wait_until(lambda: dock.value("Position", "j0 command") == goal, "its command is there")
    canvas = dock.panel("Position").locator("canvas")
    dock.wait_until(lambda: canvas.evaluate(DRAWN), "it is drawn")
    assert dock.panel("Velocity").count() == 1


def test_a_number_is_found_by_typing_and_saved(dock, tmp_path):
    dock.click("Add a panel")
    typed = dock.page.get_by_role("searchbox", name="Curve")
    typed.fill("j0 position command and state")
    dock.page.get_by_role("option", name="j0 position").first.wait_for()
    typed.press("Enter")
    typed.fill("dynamic j1 velocity")
    option = dock.page.get_by_role("option", name="/dynamic_joint_states")
    option.first.wait_for()
    typed.press("Enter")
    dock.page.keyboard.press("Escape")
    title = dock.panel("Plot 1")
    chips = title.locator(".arm-chip span")
    name = "/dynamic_joint_states.interface_values[j1].values[velocity]"
    assert chips.all_inner_texts() == ["j0", "j0 command", name]
    dock.wait_until(lambda: dock.value("Plot 1", name) == dock.value("Plot 1", name), "its value")

    def saved(kind):
        with dock.page.expect_download() as download:
            dock.click(f"Save Plot 1 as {kind}")
        download.value.save_as(tmp_path / kind)
        return tmp_path / kind

    assert saved("PNG").read_bytes().startswith(b"\x89PNG")

    def long_table():
        lines = saved("CSV").read_text().splitlines()
        return lines if len(lines) > 21 else None

    head, *rows = dock.wait_until(long_table, "20 rows in the file")
    assert head.startswith("time [s],/joint_states.position[j0] [rad],")
    assert head.endswith(f"{name} [rad/s]")
    times = [float(row.split(",")[0]) for row in rows]
    assert times == sorted(times)


def test_plots_pause_and_go_on(dock):
    dock.click("Pause the plots")
    dock.page.get_by_role("button", name="Continue the plots").wait_for()
    dock.page.locator("select[aria-label='Window of time']").select_option(label="Whole run")
    dock.click("Continue the plots")
    dock.page.locator("select[aria-label='Window of time']").select_option(label="10 s")
    assert dock.page.get_by_role("button", name="Pause the plots").count() == 1


def test_the_log_is_searched_and_follows(dock, client_for_file):
    dock.open("Log")
    log = client_for_file.node.get_logger()
    rows = dock.page.locator("[aria-label='Log'] [role=listitem]")
    log.info("a test looks for this")
    log.info("and not for that")
    dock.page.get_by_role("searchbox", name="Search the log").fill("LOOKS for test")
    rows.filter(has_text="a test looks for this").wait_for()
    assert rows.count() == 1
    dock.page.get_by_role("searchbox", name="Search the log").fill("")
    dock.page.get_by_label("Level").select_option(label="Error and worse")
    log.error("a fault that a test reports")
    rows.filter(has_text="a fault that a test reports").wait_for()
    assert "looks for this" not in dock.page.locator("[aria-label='Log']").inner_text()
    dock.page.get_by_label("Level").select_option(label="Info and worse")


def test_topics_are_measured_and_plotted(dock):
    dock.open("Topics")
    dock.page.get_by_role("searchbox", name="Search topics").fill("dynamic")
    row = dock.page.locator("[aria-label='Topics'] [role=listitem]", has_text="/dynamic_joint")
    measured = r"\d\.\d Hz\s+[\d.]+ kB/s\s+[\u2212\d.]+ ms"
    dock.wait_until(lambda: re.search(measured, row.inner_text()), "rate, bandwidth and delay")
    dock.click("Plot /dynamic_joint_states")
    assert (
        dock.page.get_by_role("searchbox", name="Curve").input_value() == "/dynamic_joint_states."
    )
    dock.page.get_by_role("option", name="/dynamic_joint_states").first.wait_for()
    dock.page.keyboard.press("Escape")


def test_frames_are_searched_and_their_poses_shown(dock):
    dock.open("Frames")
    tree = dock.page.locator("[aria-label='Frames'] .arm-frame")
    dock.page.get_by_role("searchbox", name="Search frames").fill("dyn2_r")
    # Only what leads to it is left.
    dock.wait_until(lambda: tree.all_inner_texts()[-1:] == ["dyn2_r"], "the frame")
    assert tree.first.inner_text() == "world"
    dock.click("dyn2_r")
    pose = dock.page.locator(".arm-pose")
    none = r"x 0\.0000\s+y 0\.0000\s+z 0\.0000"
    dock.page.get_by_label("Seen from").select_option(label="world")
    dock.wait_until(
        lambda: "Quaternion" in (text := pose.inner_text()) and not re.search(none, text),
        "its pose in the world",
    )
    dock.page.get_by_label("Seen from").select_option(label="dyn2_r")
    dock.wait_until(lambda: re.search(none, pose.inner_text()), "its pose in itself")
    dock.page.get_by_role("searchbox", name="Search frames").fill("")


def test_diagnostics_are_a_tree(dock):
    dock.open("Diagnostics")
    rows = dock.page.locator("[aria-label='Diagnostics'] [role=listitem]")
    controllers = rows.filter(has_text="Controllers Activity")
    controllers.wait_for()
    group = dock.page.get_by_role("button", name="Fold controller_manager", exact=True)
    group.dispatch_event("click")
    controllers.wait_for(state="detached")
    dock.click("Unfold controller_manager")
    controllers.dispatch_event("click")
    title = dock.page.locator(".arm-detail h3", has_text="controller_manager: Controllers")
    title.wait_for()
    assert title.is_visible()


@pytest.mark.parametrize("tab", ["Log", "Topics", "Frames", "Diagnostics"])
def test_on_a_phone_a_tab_has_rows_and_is_within_the_window(page, client_for_file, tab):
    client_for_file.node.get_logger().error("a line for the log")
    panel = dock_in(page, PHONE).open(tab)
    rows = ".arm-frame" if tab == "Frames" else "[role=listitem]"
    panel.locator(rows).first.wait_for()
    place = panel.bounding_box()
    assert place["x"] >= 0
    assert place["x"] + place["width"] <= PHONE["width"]


def test_a_link_carries_the_dock_to_another_browser_which_keeps_its_tab(dock, page_at, page_url):
    dock.click("Close Effort")
    dock.open("Frames")
    dock.click("Link to View")
    link = dock.page.get_by_role("link", name="the page with this view")
    link.wait_for(state="attached")
    link.dispatch_event("contextmenu")
    other = page_at(f"{page_url}/{link.get_attribute('href')}")
    shown = Dock(other)
    other.get_by_role("tab", name="Frames", exact=True, selected=True).wait_for(state="attached")
    # The tabs of viser are chosen by the whole gesture.
    for kind in ("pointerdown", "pointerup", "click"):
        other.get_by_role("tab", name="System", exact=True).dispatch_event(kind, LEFT_BUTTON)
    other.reload()
    other.get_by_role("tab", name="System", exact=True, selected=True).wait_for(state="attached")
    shown.open("Plots")
    shown.panel("Velocity").wait_for()
    assert shown.panel("Effort").count() == 0
    assert other.url.endswith("#tab=System")
    third = page_at(f"{page_url}/#tab=System")
    third.get_by_role("tab", name="System", exact=True, selected=True).wait_for(state="attached")
    # Viser would put a server that it cannot reach into the address.
    assert third.url == f"{page_url}/#tab=System"
    other.close()
    third.close()


@pytest.mark.parametrize("size", SIZES.values(), ids=SIZES)
def test_the_dock_lies_between_the_robot_and_the_edge(page, size):
    dock = dock_in(page, size)
    view = dock.page.locator("#root").bounding_box()
    place = dock.page.locator("#arm-dock").bounding_box()
    assert abs(view["y"] + view["height"] - place["y"]) < 2
    assert view["height"] > 240
    assert place["width"] == dock.page.viewport_size["width"]
    dock.click("Fold")
    dock.wait_until(
        lambda: dock.page.locator("#arm-dock").bounding_box()["height"] < 50, "it folds"
    )


def test_a_browser_keeps_peaks_and_gaps(page):
    found = page.evaluate(KEEPS_PEAKS)
    assert (max(found["kept"]), min(found["kept"])) == (9, -9)
    assert found["gap"] == 777
    assert len(found["times"]) <= 64
    assert found["times"][-16:] == list(range(4984, 5000))


class Calls(Dock):
    """The tab of calls as its user sees it."""

    def __init__(self, page) -> None:
        super().__init__(page)
        self.open("Calls")

    def find(self, words, name):
        """Type words, and choose what is found."""
        self.page.get_by_label("Find what to call").fill(words)
        row = self.page.locator(".arm-call-list button").filter(has_text=name).first
        row.dispatch_event("click")
        self.page.locator(".arm-call-deeds").wait_for()

    def press(self, label):
        button = self.page.locator(".arm-call-deeds button:not([disabled])")
        button.filter(has_text=label).dispatch_event("click")

    def says(self, text):
        self.page.locator(".arm-call-told").filter(has_text=text).wait_for()

    @property
    def answer(self):
        return self.page.locator(".arm-call-answer").inner_text()


@pytest.fixture
def calls(page):
    """Return the dock's tab of calls in a desktop's window."""
    page.set_viewport_size(DESK)
    return Calls(page)


@pytest.mark.parametrize("size", SIZES.values(), ids=SIZES)
def test_a_service_answers(page, size):
    page.set_viewport_size(size)
    calls = Calls(page)
    calls.find("service list_controllers", "/controller_manager/list_controllers")
    calls.press("Call")
    calls.says("Answered after")
    assert "name: position_controller" in calls.answer


def test_a_message_moves_the_arm_and_one_that_does_not_fit_is_refused(calls, client_for_file):
    states = client_for_file.subscribe(JointState, "/joint_states")
    calls.find("topic position_controller", "/position_controller/commands")
    field = calls.page.get_by_label("data", exact=True)
    field.fill("[fast]")
    calls.press("Publish once")
    calls.says("data[0]: 'fast' is not a number (float64)")
    field.fill("[0.3, 0, 0, 0]")
    calls.press("Publish once")
    calls.says("Published once")

    def turned(message: JointState) -> float:
        return message.position[list(message.name).index("j0")]

    seen = states.wait_until(lambda m: m and abs(turned(m[-1]) - 0.3) < 0.05, "the arm moved")
    assert turned(seen[-1]) == pytest.approx(0.3, abs=0.05)


def test_a_parameter_is_set_and_one_out_of_its_range_is_refused(calls):
    calls.find("parameters arm_gazebo", "/arm_gazebo")
    field = calls.page.get_by_label("real_time_factor", exact=True)
    field.fill("-1")
    calls.press("Set changed")
    calls.says("real_time_factor")
    assert "arm-failed" in calls.page.locator(".arm-call-told").get_attribute("class")
    field.fill("0.8")
    calls.press("Set changed")
    calls.says("Set 1 of 1")
