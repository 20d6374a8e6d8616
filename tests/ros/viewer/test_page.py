"""The page in a real browser, beside a simulation: one of each for the file."""

import itertools
import time
from urllib.parse import urlsplit

import numpy as np
import pytest
from controller_manager_msgs.msg import ControllerManagerActivity
from page_user import TIMEOUT_S
from sensor_msgs.msg import JointState
from std_msgs.msg import Float64MultiArray

pytestmark = pytest.mark.timeout(600)

ARRIVAL_S = 10.0
"""The arm takes two seconds from one end of a slider to the other."""
OPEN_WEBSOCKET = """(url) => new Promise((say) => {
  const socket = new WebSocket(url);
  socket.onopen = () => say("accepted");
  socket.onerror = () => say("refused");
})"""


@pytest.fixture
def client(client_for_file):
    """One client for the file: a new one would have to be discovered beside a busy browser."""
    return client_for_file


@pytest.fixture(scope="module")
def visitor(visitor):
    """A visitor who has seen the camera's picture and hidden it: each more takes its time."""
    assert visitor.camera_pixels().size
    visitor.switch("Show", False)
    return visitor


@pytest.fixture
def positions(client):
    """Return the joints' newest positions on /joint_states, by a function."""
    states = client.subscribe(JointState, "/joint_states")

    def newest() -> dict[str, float]:
        message = states.wait_for()[-1]
        return dict(zip(message.name, message.position, strict=True))

    return newest


@pytest.fixture
def command(client):
    """Send positions to the controller, by a function; a message may be lost, so send it again."""
    publisher = client.publisher(Float64MultiArray, "/position_controller/commands")

    def send(values) -> None:
        publisher.publish(Float64MultiArray(data=values))

    return send


def test_the_page_loads_and_fetches_nothing_from_outside(visitor, page_url):
    visitor.slider("j3").wait_for(state="attached")
    visitor.wait_until(lambda: visitor.drawn()["triangles"] > 0, "the robot is drawn")
    outside = {
        url
        for url in visitor.requests
        if urlsplit(url).scheme in ("http", "https", "ws", "wss")
        and urlsplit(url).netloc != urlsplit(page_url).netloc
    }
    assert visitor.requests
    assert outside == set()
    assert visitor.errors == []


SHADOWS = """() => {
  const lights = [];
  window.__viserMutable.scene.traverse((node) => { if (node.isLight) lights.push(node); });
  return lights.some((light) => light.castShadow);
}"""
PIXELS = "() => window.__viserTestpoints.devSettings.get().fixedDpr"
IS_READ = """() => {
  const canvas = document.createElement("canvas");
  return canvas.getContext("2d").getContextAttributes().willReadFrequently;
}"""


def test_a_browser_without_a_graphics_card_draws_without_what_costs_most(
    visitor, new_visitor, command
):
    visitor.wait_until(lambda: visitor.drawn()["triangles"] > 0, "the robot is drawn")
    assert visitor.drawn()["antialias"]
    visitor.wait_until(lambda: visitor.page.evaluate(SHADOWS), "a light casts a shadow")
    assert visitor.page.evaluate(PIXELS) is None
    assert not visitor.page.evaluate(IS_READ)
    slow = new_visitor("window.renderer = 'SwiftShader'")
    page = slow.page
    slow.wait_until(lambda: slow.drawn()["triangles"] > 0, "the robot is drawn")
    slow.wait_until(lambda: not page.evaluate(SHADOWS), "no light casts a shadow")
    assert not slow.drawn()["antialias"]
    assert page.evaluate(IS_READ)
    goals = itertools.cycle([0.5, -0.5])

    def moves_in_fewer_pixels() -> bool:
        command([next(goals), 0.0, 0.0, 0.0])
        return (page.evaluate(PIXELS) or 1.0) < 1.0

    slow.wait_until(moves_in_fewer_pixels, "the moving scene has fewer pixels")
    slow.wait_until(lambda: page.evaluate(PIXELS) == 1.0, "the scene at rest has all of them")
    assert slow.errors == []
    page.close()


def test_a_slider_is_long_enough_to_be_dragged(visitor):
    visitor.slider("j0").wait_for(state="attached")
    assert visitor.place(".mantine-Slider-root")["width"] > 160


def test_on_a_phone_the_robot_is_above_a_sheet_that_closes(new_visitor):
    phone = new_visitor(viewport={"width": 390, "height": 844})
    view, sheet = "canvas[data-engine]", "#root .mantine-Paper-root"

    def is_above() -> bool:
        top, bottom = phone.place(view), phone.place(sheet)
        return bottom["width"] == 390 and abs(top["y"] + top["height"] - bottom["y"]) < 2

    phone.wait_until(is_above, "the robot is above the sheet")
    height = phone.place(view)["height"]
    assert height > 844 / 3
    assert phone.place("[aria-label='Expand panel Cameras']")["y"] < 844
    phone.page.get_by_text("Connected").click()
    phone.wait_until(lambda: is_above() and phone.place(view)["height"] > height, "it closes")
    assert phone.place(sheet)["height"] < 80
    assert phone.errors == []
    phone.page.close()


FRAME_OF_CHANNEL = """() => {
  const poses = Object.entries(window.__viserMutable.nodePoseData);
  // The channel's numbers have half the length of viser's.
  const isShort = (value) => value === Math.fround(value);
  const isTurned = ({wxyz}) => wxyz.some((value) => value % 0.5 !== 0);
  return poses.some(([name, pose]) =>
    name.startsWith("/frames/") && isTurned(pose) && pose.wxyz.every(isShort));
}"""


def test_the_robot_moves_by_frames_of_the_pages_own_channel(visitor, command):
    goals = itertools.cycle([0.5, -0.5])

    def moves() -> bool:
        command([next(goals), 0.0, 0.0, 0.0])
        return visitor.page.evaluate(FRAME_OF_CHANNEL)

    visitor.wait_until(moves, "a link's pose comes from the channel")
    assert visitor.errors == []


EYE = """() => {
  const { camera } = window.__viserMutable;
  return [...camera.position.toArray(), ...camera.up.toArray(), camera.fov];
}"""


def test_a_browser_looks_from_a_camera_and_back(visitor, new_visitor):
    visitor.wait_until(lambda: visitor.drawn()["triangles"] > 0, "the robot is drawn")
    other = new_visitor()
    other.wait_until(lambda: other.drawn()["triangles"] > 0, "the robot is drawn there, too")

    def is_at(eye) -> bool:
        return np.allclose(other.page.evaluate(EYE), eye, atol=1e-3)

    # A view that its user has chosen is not fitted again.
    other.step_back()
    seen: list[list[float]] = [[], []]

    def rests() -> bool:
        seen.append(other.page.evaluate(EYE))
        other.page.wait_for_timeout(500)
        return seen[-1] == seen[-2] == seen[-3]

    other.wait_until(rests, "the view rests")
    eye, free = seen[-1], visitor.page.evaluate(EYE)
    other.click("Look from here")
    other.page.get_by_text("View from /videocamera").wait_for()
    # Where the URDF puts the camera beside the arm, in three.js's axes.
    other.wait_until(
        lambda: np.allclose(other.page.evaluate(EYE)[:3], (0.0, 0.5313, -0.75), atol=1e-3),
        "the view is that of the camera",
    )
    assert np.allclose(visitor.page.evaluate(EYE), free, atol=1e-3), "another browser stays"
    other.click("Free camera")
    other.wait_until(lambda: is_at(eye), "it is back")
    assert other.errors == []
    other.page.close()


def test_a_slider_moves_the_simulated_arm(visitor, positions):
    assert positions()["j0"] < 1.0

    def moved() -> bool:
        # It has no effect before the page knows of the controller.
        visitor.slider("j0").press("End")
        return positions()["j0"] > 2.4

    visitor.wait_until(moved, "j0 goes to its limit")
    assert abs(positions()["j1"]) < 0.1


def test_a_slider_follows_when_somebody_else_moves_the_arm(visitor, command):
    def followed() -> bool:
        command([-1.0, 0.5, 0.0, 0.0])
        return visitor.slider_value("j0") < -0.9 and visitor.slider_value("j1") > 0.4

    visitor.wait_until(followed, "the sliders of j0 and j1 follow")
    assert visitor.slider_value("j0") == pytest.approx(-1.0, abs=0.1)


@pytest.fixture
def commands(client, visitor, positions):
    """Return the commands that the page sends from now on, once it can drive the arm."""
    heard = client.subscribe(Float64MultiArray, "/position_controller/commands")

    def moved() -> bool:
        visitor.slider("j0").press("End")
        visitor.slider("j0").press("Home")
        # The arm is given the time to get there: pressed again at once, the keys hold it halfway.
        pressed_s = time.monotonic()
        while time.monotonic() < pressed_s + ARRIVAL_S:
            if heard.messages and positions()["j0"] < -2.56:
                return True
            visitor.page.wait_for_timeout(100)
        return False

    visitor.wait_until(moved, "the page drives the arm, and is heard")
    # Nothing else is where one step from the end is: what was pressed before has been heard.
    visitor.slider("j0").press("ArrowRight")
    visitor.wait_until(lambda: -2.5695 < heard.messages[-1].data[0] < 0.0, "the last command")
    heard.clear()
    return heard


def test_a_typed_number_is_sent_when_complete_and_as_typed(visitor, positions, commands):
    visitor.type_number("j0", "-0.5", "Enter")
    visitor.wait_until(lambda: abs(positions()["j0"] + 0.5) < 0.01, "j0 goes to -0.5")
    visitor.wait_until(lambda: len(commands.messages) > 0, "the command is heard")
    assert [message.data[0] for message in commands.messages] == [-0.5]
    visitor.type_number("j1", "1e-2", "Tab")
    visitor.wait_until(lambda: len(commands.messages) == 2, "Tab sends the number of j1")
    assert commands.messages[-1].data[1] == 0.01


def test_two_numbers_typed_in_succession_both_arrive(visitor, commands):
    visitor.type_number("j1", "0.12345")
    visitor.type_number("j2", "-0.25", "Enter")
    visitor.wait_until(lambda: len(commands.messages) == 2, "two commands")
    assert commands.messages[0].data[1] == 0.12345
    assert list(commands.messages[1].data[1:3]) == [0.12345, -0.25]


def test_a_number_is_pasted(visitor, commands):
    visitor.type_number("j1", "0.4321", "Enter")
    # What was entered is marked.
    visitor.page.keyboard.press("Control+C")
    visitor.type_number("j2", "Control+V", "Enter", press=True)
    visitor.wait_until(lambda: len(commands.messages) == 2, "two commands")
    assert list(commands.messages[1].data[1:3]) == [0.4321, 0.4321]


def test_an_invalid_position_is_refused_with_a_sentence(visitor, commands):
    visitor.type_number("j1", "-", "Enter")
    visitor.page.get_by_text("'-' is not a number").wait_for()
    visitor.type_number("j1", "7", "Enter")
    visitor.page.get_by_text("'j1' goes from -3.14").wait_for()
    visitor.type_number("j1", "0.2", "Escape")
    visitor.type_number("j1", "0.1", "Enter")
    visitor.wait_until(lambda: len(commands.messages) > 0, "a command")
    assert [message.data[1] for message in commands.messages] == [0.1]


def test_the_tab_of_the_browser_bears_the_projects_name_and_icon(visitor):
    assert visitor.page.title() == "Arm suite"
    icon = visitor.page.locator("link[rel=icon]").get_attribute("href")
    assert icon.startswith("data:image/svg+xml,")
    assert visitor.page.evaluate(
        "(icon) => new Promise((say) => { const image = new Image();"
        " image.onload = () => say(image.naturalWidth > 0); image.onerror = () => say(false);"
        " image.src = icon; })",
        icon,
    )


def test_the_camera_panel_shows_the_arm_move(visitor, command):
    visitor.switch("Show", True)
    before = visitor.camera_pixels()

    def moved() -> bool:
        command([1.0, -0.5, 0.5, 0.5])
        return np.count_nonzero(np.abs(visitor.camera_pixels() - before) > 40) > 20

    visitor.wait_until(moved, "the image shows another pose")
    assert visitor.camera_pixels().shape == before.shape
    visitor.switch("Show", False)


def test_the_frustum_of_the_camera_can_be_hidden(visitor):
    def seen() -> bool:
        # The camera stands beside what the page shows at first.
        visitor.step_back()
        return not nothing_but_faces_is_drawn(visitor)

    visitor.switch("Cameras", True)
    visitor.wait_until(seen, "its edges are drawn")
    visitor.switch("Cameras", False)
    visitor.wait_until(lambda: nothing_but_faces_is_drawn(visitor), "no edges are drawn")
    assert nothing_but_faces_is_drawn(visitor)


def test_the_collision_switch_shows_wire_frames(visitor):
    # Frustums of cameras have edges, too.
    visitor.switch("Cameras", False)
    visitor.switch("Collision", False)
    visitor.wait_until(lambda: nothing_but_faces_is_drawn(visitor), "no edges are drawn")
    before = visitor.drawn()["instances"]
    visitor.switch("Collision", True)
    visitor.wait_until(lambda: visitor.drawn()["instances"] > before, "wire frames are drawn")
    visitor.switch("Collision", False)
    visitor.wait_until(lambda: nothing_but_faces_is_drawn(visitor), "no wire frames are drawn")
    assert nothing_but_faces_is_drawn(visitor)


def nothing_but_faces_is_drawn(visitor) -> bool:
    before = visitor.drawn()
    visitor.wait_until(lambda: visitor.drawn()["triangles"] > before["triangles"], "a frame")
    return visitor.drawn()["instances"] == before["instances"]


def test_controllers_are_deactivated_and_activated(visitor, client, latched):
    activity = client.subscribe(ControllerManagerActivity, "/controller_manager/activity", latched)

    def state() -> str:
        controllers = activity.wait_for()[-1].controllers
        return next(c.state.label for c in controllers if c.name == "position_controller")

    assert state() == "active"
    visitor.open_tab("Control")
    visitor.controller_button("position_controller", "Deactivate").click()
    visitor.wait_until(lambda: state() == "inactive", "the manager deactivates the controller")
    visitor.controller_button("position_controller", "Activate").click()
    visitor.wait_until(lambda: state() == "active", "the manager activates the controller")
    visitor.controller_button("position_controller", "Deactivate").wait_for()
    visitor.open_tab("Robot")


def test_the_node_graph_is_shown(visitor):
    visitor.open_tab("System")
    visitor.switch("Node graph", True)
    node = visitor.page.locator("svg text", has_text="/joint_state_broadcaster").first
    node.wait_for()
    visitor.switch("Node graph", False)
    node.wait_for(state="hidden")
    assert not node.is_visible()
    visitor.open_tab("Robot")


def test_a_page_of_another_origin_is_refused(visitor, browser, page_url):
    address = page_url.replace("http:", "ws:")
    assert visitor.page.evaluate(OPEN_WEBSOCKET, address) == "accepted"
    foreign = browser.new_page()
    foreign.set_default_timeout(TIMEOUT_S * 1000)
    foreign.route("http://localhost:1/", lambda route: route.fulfill(body="<p>hello</p>"))
    foreign.goto("http://localhost:1/")
    assert foreign.evaluate(OPEN_WEBSOCKET, address) == "refused"
    foreign.close()


def test_the_page_continues_when_the_simulation_restarts(
    visitor, simulation, launch_for_file, client
):
    banner = visitor.page.get_by_role("alert")
    banner.wait_for(state="hidden")
    assert simulation.stop() == 0, simulation.output
    banner.get_by_text("The simulation has ended").wait_for()
    launch_for_file("camera:=none").wait_until_ready()
    banner.wait_for(state="hidden")
    visitor.page.locator("#arm-bar.arm-playing").wait_for()
    states = client.subscribe(JointState, "/joint_states")

    def moved() -> bool:
        # A slider returns to its joint that does not follow: then it can be pulled again.
        visitor.slider("j0").press("Home")
        return states.wait_for()[-1].position[0] < -2.4

    visitor.wait_until(moved, "a slider moves the arm again")


def test_a_saved_configuration_is_opened_again(visitor, tmp_path):
    visitor.open_tab("Robot")
    collision = visitor.checkbox("Collision")
    collision.wait_for(state="attached")
    shown = collision.is_checked()
    with visitor.page.expect_download() as started:
        visitor.button("Save Config As").dispatch_event("click")
    path = tmp_path / "page.rviz"
    started.value.save_as(path)
    assert f"Collision Enabled: {str(shown).lower()}" in path.read_text()
    assert "Distance" in path.read_text()
    visitor.switch("Collision", not shown)
    with visitor.page.expect_file_chooser() as chooser:
        visitor.button("Open Config").dispatch_event("click")
    chooser.value.set_files(path)
    visitor.wait_until(lambda: collision.is_checked() == shown, "the switch is as it was saved")


def test_an_address_opens_the_page_with_its_view(visitor):
    base = visitor.page.url.partition("?")[0]
    visitor.visit(f"{base}?initialCameraPosition=2,3,2.5&initialCameraLookAt=0,0,0.25")
    visitor.open_tab("Robot")
    visitor.checkbox("Collision").wait_for(state="attached")
    link = visitor.page.locator("a[href*='initialCameraPosition']")

    def address() -> str:
        visitor.button("Link to View").dispatch_event("click")
        return link.get_attribute("href") if link.count() else ""

    visitor.wait_until(address, "a link")
    assert address() == "?initialCameraPosition=2,3,2.5&initialCameraLookAt=0,0,0.25"
    visitor.visit(base)
