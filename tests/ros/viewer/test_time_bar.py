"""The bar of time and emergency stop in a real browser, beside a real launch: one for the file."""

import re

import pytest
from page_user import DESK, KEEP_WHAT_IS_SAID, PHONE, PageUser
from simulated import PAUSED, PLAYING, Simulated
from std_msgs.msg import Bool
from std_srvs.srv import SetBool

pytestmark = pytest.mark.timeout(600)

PERIOD_S = 0.01
TOLERANCE_S = 0.03
CAMERA = "none"
KEEP_TIMES = """
  window.times = [];
  armChannel.on("clock", ({ time_s }) => window.times.push(time_s));
"""


@pytest.fixture(scope="module")
def bar(page_at, simulation, page_url):
    """Return the bar of a page in a window of a desktop."""
    return Bar(page_at(page_url, KEEP_WHAT_IS_SAID))


@pytest.fixture
def phone(bar):
    """Return the bar in a window of a phone's size."""
    bar.resize(PHONE)
    yield bar
    bar.resize(DESK)


class Bar(PageUser):
    """The bar as its user sees it."""

    def __init__(self, page):
        super().__init__(page)
        page.evaluate(KEEP_TIMES)

    def button(self, name):
        return self.page.get_by_role("button", name=name, exact=True)

    def element(self, name):
        return self.page.locator(f"#arm-{name}")

    def shows(self, name, pattern):
        """Wait until an element's text matches; return it."""

        def found():
            text = self.element(name).inner_text()
            return text if re.search(pattern, text) else None

        return self.wait_until(found, f"{name} shows {pattern}")

    @property
    def time_s(self):
        return float(self.element("clock").inner_text().removesuffix(" s"))

    def shows_time(self, time_s):
        self.wait_until(lambda: abs(self.time_s - time_s) < TOLERANCE_S, f"{time_s} s")

    def pause(self):
        """Pause, whatever the state; return the time once it stands.

        The last /clock may arrive after the news of the pause. The page tells the same time twice
        only when nothing newer has arrived for most of a second.
        """
        if self.shows("state", "^(Playing|Paused)$") == "Playing":
            self.click("Pause")
        self.shows("state", "^Paused$")
        self.page.evaluate("window.times.length = 0")
        self.wait_until(self._stands, "the clock stands")
        return self.time_s

    def _stands(self):
        last = self.page.evaluate("window.times.slice(-2)")
        return len(last) == 2 and last[0] == last[1]


@pytest.fixture
def client(client_for_file):
    """One client for the file: a new one would have to be discovered beside a busy browser."""
    return client_for_file


@pytest.fixture
def state(client):
    """Return a function that asks the simulation for its state."""
    return Simulated(client).state


@pytest.fixture
def stopped(client, latched):
    """Collect what /emergency_stop/active says."""
    return client.subscribe(Bool, "/emergency_stop/active", latched)


def test_the_emergency_stop_is_whole_however_long_the_words_beside_it(bar):
    right, width = bar.page.evaluate("""() => {
      document.getElementById("arm-lag").textContent = "12345.67 s behind";
      return [document.getElementById("arm-stop").getBoundingClientRect().right, innerWidth];
    }""")
    assert right <= width


def test_the_clock_is_whole_on_a_phone(bar):
    bar.page.set_viewport_size(PHONE)
    clock, words = bar.page.evaluate("""() => [document.getElementById("arm-clock"),
      document.querySelector(".arm-time")].map(e => e.getBoundingClientRect().right)""")
    bar.page.set_viewport_size(DESK)
    assert clock <= words <= PHONE["width"]


def test_time_is_paused_stepped_and_goes_on(bar, state):
    bar.shows("factor", "^\u00d7[0-9]")
    before_s = bar.pause()
    assert state() == PAUSED
    assert bar.element("factor").inner_text() == ""
    assert bar.element("lag").inner_text() == ""
    bar.click("Step once")
    bar.wait_until(lambda: bar.time_s > before_s, "a step")
    for name, count in (("Step 10 times", 10), ("Step 100 times", 100)):
        before_s = bar.time_s
        bar.click(name)
        bar.shows_time(before_s + count * PERIOD_S)
    bar.click("Play")
    bar.shows("state", "^Playing$")
    assert state() == PLAYING
    bar.page.locator("[data-steps='1'][title^='Pause first']").wait_for()


def test_the_speed_is_chosen(bar, client):
    def speed():
        return client.get_parameter("/arm_gazebo", "real_time_factor")

    bar.element("speed").select_option(label="0.5\u00d7")
    client.wait_until(lambda: speed() == 0.5, "the simulation's speed")
    bar.shows("factor", "^\u00d70[.][45]")
    bar.element("speed").select_option(label="1\u00d7")
    client.wait_until(lambda: speed() == 1.0, "real time")
    assert speed() == 1.0


def test_a_snapshot_is_saved_listed_restored_and_removed(bar):
    bar.pause()
    bar.click("Snapshots")
    bar.element("name").fill("before")
    bar.click("Save")
    saved_s = float(re.search("^Saved 'before': (.*) s in", bar.says("^Saved"))[1])
    bar.shows_time(saved_s)
    bar.page.keyboard.press("Escape")
    bar.click("Step 100 times")
    bar.shows_time(saved_s + 1.0)
    bar.click("Snapshots")
    bar.click("Restore before")
    bar.shows_time(saved_s)
    bar.click("Snapshots")
    bar.click("Remove before")
    bar.element("none-saved").wait_for()
    assert bar.element("none-saved").is_visible()
    bar.page.keyboard.press("Escape")


def test_a_reset_keeps_the_clock_or_sets_it_to_zero(bar):
    before_s = bar.pause()
    bar.click("Reset")
    bar.page.get_by_role("menuitem", name="keep the clock").dispatch_event("click")
    bar.says("the clock goes on")
    bar.shows_time(before_s)
    bar.click("Reset")
    bar.page.get_by_role("menuitem", name="clock to zero").dispatch_event("click")
    bar.shows_time(0.0)
    # Without news for two seconds, on a busy machine, it says "No answer" for a while.
    assert bar.shows("state", "^Paused$")


def test_the_emergency_stop_is_engaged_at_once_and_released_by_two_clicks(bar, stopped):
    stopped.wait_until(lambda m: m and not m[-1].data, "no stop")
    bar.click("Emergency stop")
    bar.button("Stopped").wait_for()
    stopped.wait_until(lambda m: m[-1].data, "the stop")
    bar.says("holds until it is released")
    bar.click("Release stop")
    bar.button("Confirm release").wait_for()
    assert stopped.messages[-1].data
    bar.click("Confirm release")
    bar.button("Emergency stop").wait_for()
    stopped.wait_until(lambda m: not m[-1].data, "the release")
    assert not bar.element("release").is_visible()


def test_a_stop_from_elsewhere_is_shown(bar, client):
    client.call(SetBool, "/emergency_stop", SetBool.Request(data=True))
    bar.button("Stopped").wait_for()
    assert bar.button("Release stop").is_visible()
    client.call(SetBool, "/emergency_stop", SetBool.Request(data=False))
    bar.button("Emergency stop").wait_for()


def test_on_a_phone_the_stop_is_under_the_thumb_and_the_bar_has_two_lines(phone):
    bar = phone.page.locator("#arm-bar").bounding_box()
    assert bar["height"] < 100
    place = phone.button("Emergency stop").bounding_box()
    assert place["y"] + place["height"] > PHONE["height"] - 20
    assert place["width"] > 300
    assert place["height"] > 44
    for name in ("play", "reset", "snapshots", "help"):
        inside = phone.element(name).bounding_box()
        assert inside["x"] + inside["width"] <= PHONE["width"]
        assert inside["y"] + inside["height"] <= bar["height"]
    phone.pause()
    phone.click("Emergency stop")
    phone.button("Stopped").wait_for()
    phone.click("Release stop")
    phone.click("Confirm release")
    phone.button("Emergency stop").wait_for()
    phone.click("Play")
    assert phone.shows("state", "^Playing$") == "Playing"


def test_without_a_simulation_the_bar_says_why_it_is_grey(bar, simulation):
    assert simulation.stop() == 0, simulation.output
    bar.shows("state", "^No simulation$")
    bar.page.locator("#arm-play[title='No simulation: time cannot be paused']").wait_for()
    bar.page.locator("#arm-stop[aria-disabled=true]").wait_for()
    bar.element("play").dispatch_event("click")
    assert bar.says("^No simulation: time cannot be paused$")


def test_the_bar_survives_the_end_of_the_pages_process(
    bar, page_url, page_program, launch_for_file
):
    assert page_program.stop() == 0, page_program.output
    bar.shows("state", "^No contact$")
    bar.element("stop").dispatch_event("click")
    assert bar.says("^NOT STOPPED")
    port = page_url.rpartition(":")[2]
    launch_for_file("arm_viewer", "viewer.launch.py", f"viewer_port:={port}")
    assert bar.shows("state", "^No simulation$") == "No simulation"
