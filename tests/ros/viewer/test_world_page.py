"""The tab of the world in a real browser, beside a real launch: one for the file.

A thing is added, chosen, pushed, moved and deleted; files are dropped; another world is loaded.
"""

import base64
import re

import pytest
from page_user import DESK, KEEP_WHAT_IS_SAID, PHONE, PageUser
from simulated import Simulated

pytestmark = pytest.mark.timeout(600)

CAMERA = "none"
SIZES = {"desk": DESK, "phone": PHONE}
on_each = pytest.mark.parametrize("world", SIZES, indirect=True)
CONTACT = re.compile("Playing|Clock only|No answer|No simulation")
DROP = """([name, data]) => {
  const files = new DataTransfer();
  files.items.add(new File([Uint8Array.from(atob(data), (c) => c.charCodeAt(0))], name));
  for (const kind of ["dragover", "drop"]) {
    const event = new DragEvent(kind, { dataTransfer: files, bubbles: true, cancelable: true });
    document.body.dispatchEvent(event);
  }
}"""
AT_ONCE = """async ([texts, button]) => {
  const set = Object.getOwnPropertyDescriptor(HTMLInputElement.prototype, "value").set;
  for (const [label, text] of Object.entries(texts)) {
    const place = `//label[.='${label}']/following::input[1]`;
    const field = document.evaluate(place, document, null, 9).singleNodeValue;
    set.call(field, text);
    field.dispatchEvent(new Event("input", { bubbles: true }));
    await new Promise((go) => setTimeout(go, 1));
  }
  [...document.querySelectorAll("button")].find((b) => b.textContent === button).click();
}"""
"""A script that types into fields and presses a button as fast as a browser can."""
POST = b"""<robot name="post"><link name="post">
  <inertial><mass value="1"/><inertia ixx="1" ixy="0" ixz="0" iyy="1" iyz="0" izz="1"/></inertial>
  <collision><geometry><box size="0.02 0.02 0.2"/></geometry></collision></link></robot>"""


@pytest.fixture(scope="module")
def page(page_at, simulation, page_url):
    """Return the page of a browser, at first on a phone, where its sheet is open."""
    opened = page_at(page_url, KEEP_WHAT_IS_SAID, PHONE)
    # What is dropped before there is contact is lost.
    opened.locator("#arm-state", has_text=CONTACT).wait_for(state="attached")
    return opened


@pytest.fixture
def world(page, request, client_for_file):
    """Return the tab in a window of a size, a desk's unless the test says otherwise."""
    tab = World(page, client_for_file)
    tab.resize(SIZES[getattr(request, "param", "desk")])
    page.get_by_role("tab", name="World", exact=True).click()
    return tab


class World(PageUser):
    """The tab as its user sees it."""

    def __init__(self, page, client) -> None:
        super().__init__(page)
        self.client = client

    def press(self, label):
        self.page.get_by_role("button", name=label, exact=True).dispatch_event("click")

    def enter(self, label, text):
        fields = self.page.locator(f"xpath=//label[.='{label}']/following::input[1]")
        field = fields.locator("visible=true")
        field.fill(text)
        field.press("Enter")

    def unfold(self, folder, label):
        head = self.page.get_by_text(folder, exact=True).first
        # What it holds comes with it: before, an open one would look like one that is folded.
        head.wait_for(state="attached")
        if not self.page.get_by_role("button", name=label, exact=True).is_visible():
            head.dispatch_event("click")
            self.page.get_by_role("button", name=label, exact=True).wait_for()

    def thing(self, name):
        return self.page.locator(f"[data-thing={name}]")

    def choose(self, name):
        if self.thing(name).get_attribute("aria-pressed") == "false":
            self.thing(name).dispatch_event("click")
        self.page.locator(f"[data-thing={name}][aria-pressed=true]").wait_for()
        self.page.get_by_role("button", name="Delete", exact=True).wait_for()

    def shows(self, text):
        self.page.get_by_text(text).first.wait_for()

    def drop(self, name, data):
        self.page.evaluate(DROP, [name, base64.b64encode(data).decode()])

    def parameter(self, name):
        return self.client.get_parameter("/simulation", name)

    def position(self, name):
        return Simulated(self.client).state_of(name).pose.position


@on_each
def test_a_box_is_added_pushed_moved_and_deleted(world):
    world.unfold("Add", "Add")
    world.enter("Position", "0.3 0.1 0.03")
    world.press("Add")
    world.thing("box").wait_for()
    world.choose("box")
    before = world.position("box")
    assert (before.x, before.y) == pytest.approx((0.3, 0.1), abs=0.02)
    world.enter("Push to", "0 0.6 0")
    world.press("Push")
    world.shows("Pushed box")
    world.wait_until(lambda: world.position("box").y > before.y + 0.001, "the box moves")
    world.enter("Move to", "0.5 -0.4 0.025")
    world.press("Move")
    world.shows("box: x y z 0.500 -0.400 0.02")
    assert world.position("box").y == pytest.approx(-0.4, abs=0.01)
    world.press("Delete")
    world.thing("box").wait_for(state="detached")
    world.shows("Deleted box")


def test_what_is_typed_and_pressed_within_a_moment_counts(world):
    world.unfold("Add", "Add")
    typed = {"Name": "quick", "Size": "0.02 0.03 0.04", "Position": "0.3 0.2 0.02"}
    world.page.evaluate(AT_ONCE, [typed, "Add"])
    world.thing("quick").wait_for()
    place = world.position("quick")
    assert (place.x, place.y) == pytest.approx((0.3, 0.2), abs=0.01)
    world.enter("Size", "0.05 0.05 0.05")
    world.enter("Name", "box")
    world.choose("quick")
    world.press("Delete")
    world.thing("quick").wait_for(state="detached")


def test_mass_and_friction_of_a_box_are_shown_and_set(world):
    world.unfold("Add", "Add")
    world.enter("Position", "0.3 0.1 0.03")
    world.press("Add")
    world.thing("box").wait_for()
    world.choose("box")
    world.shows("0.1 kg, friction 1")
    world.enter("Mass to", "0.25")
    world.enter("Friction to", "0.3")
    world.press("Set")
    world.shows("box: 0.25 kg, friction 0.3")
    assert world.parameter("entities.box.mass") == 0.25
    assert world.parameter("entities.box.friction") == 0.3
    world.shows("0.25 kg, friction 0.3")
    world.press("Set")
    world.shows("Type another mass or friction first: these are the present ones.")
    world.enter("Mass to", "-1")
    world.press("Set")
    world.shows("the mass of 'box' is 1e-06 to 1e+06 kg, not -1 kg")
    world.enter("Mass to", "heavy")
    world.press("Set")
    world.shows("The mass is not a number: 'heavy'")
    assert world.parameter("entities.box.mass") == 0.25
    world.press("Delete")
    world.thing("box").wait_for(state="detached")


def test_gravity_is_shown_and_set(world):
    world.shows("Gravity 0 0 -9.81 m/s²")
    world.unfold("Gravity", "Set gravity")
    world.press("Moon")
    field = world.page.locator("xpath=//label[.='Gravity']/following::input[1]")
    world.wait_until(lambda: field.input_value() == "0 0 -1.62", "the Moon's gravity in the field")
    world.press("Set gravity")
    world.shows("Gravity 0 0 -1.62 m/s²")
    assert world.parameter("gravity") == [0.0, 0.0, -1.62]
    world.enter("Gravity", "0 0 -1000")
    world.press("Set gravity")
    world.shows("the gravity is three numbers x y z from -100 to 100 m/s2")
    world.enter("Gravity", "0 0 -9.81")
    world.press("Set gravity")
    world.shows("Gravity is 0 0 -9.81 m/s²")
    assert world.parameter("gravity") == [0.0, 0.0, -9.81]


def test_a_wrong_field_is_a_sentence(world):
    world.unfold("Add", "Add")
    world.enter("Size", "0.1")
    world.press("Add")
    world.shows("The size is not 'x y z' in numbers: '0.1'")
    world.enter("Size", "0.05 0.05 0.05")
    assert world.thing("box").count() == 0


@on_each
def test_a_file_is_dropped_and_its_check_shown(world):
    world.drop("post.urdf", POST)
    world.thing("post").wait_for()
    world.shows("usable:")
    world.choose("post")
    world.press("Delete")
    world.thing("post").wait_for(state="detached")
    assert world.page.locator("#arm-drop").is_hidden()


def test_a_broken_file_and_one_of_another_kind_are_refused(world):
    world.drop("broken.urdf", b"<robot name='x'><link name='a'></robot>")
    world.shows("broken.urdf cannot be simulated")
    world.drop("photo.png", b"x")
    assert world.says("photo.png is not a URDF, SDF or STL file", is_problem=True)


@on_each
def test_another_world_is_loaded(world):
    world.unfold("Other world", "Load")
    wanted = "shapes" if world.page.viewport_size == SIZES["desk"] else "empty"
    world.page.get_by_role("combobox", name="Available").click()
    world.page.get_by_role("option", name=wanted, exact=True).click()
    world.press("Load")
    world.shows(f"Loaded {wanted}")
    assert Simulated(world.client).do("GetCurrentWorld").world.name == wanted
