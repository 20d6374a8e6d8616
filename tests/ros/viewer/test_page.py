"""The page in a real browser, beside a simulation: one of each for the file."""

import re
from urllib.parse import urlsplit

import numpy as np
import pytest

pytestmark = [pytest.mark.ros, pytest.mark.timeout(600)]

OPEN_WEBSOCKET = """(url) => new Promise((say) => {
  const socket = new WebSocket(url);
  socket.onopen = () => say("accepted");
  socket.onerror = () => say("refused");
})"""


@pytest.fixture
def positions(client):
    """Return the joints' newest positions on /joint_states, by a function."""
    from sensor_msgs.msg import JointState

    states = client.subscribe(JointState, "/joint_states")

    def newest() -> dict[str, float]:
        message = states.wait_for()[-1]
        return dict(zip(message.name, message.position, strict=True))

    return newest


@pytest.fixture
def command(client):
    """Send positions to the controller, by a function; a message may be lost, so send it again."""
    from std_msgs.msg import Float64MultiArray

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


def test_the_camera_panel_shows_the_arm_move(visitor, command):
    before = visitor.camera_pixels()

    def moved() -> bool:
        command([1.0, -0.5, 0.5, 0.5])
        return np.count_nonzero(np.abs(visitor.camera_pixels() - before) > 40) > 20

    visitor.wait_until(moved, "the image shows another pose")


def test_the_frustum_of_the_camera_can_be_hidden(visitor):
    def seen() -> bool:
        # The camera stands beside what the page shows at first.
        visitor.step_back()
        return not nothing_but_faces_is_drawn(visitor)

    visitor.wait_until(seen, "its edges are drawn")
    visitor.tick("Cameras")
    visitor.wait_until(lambda: nothing_but_faces_is_drawn(visitor), "no edges are drawn")


def test_the_collision_switch_shows_wire_frames(visitor):
    before = visitor.drawn()["instances"]
    visitor.tick("Collision")
    visitor.wait_until(lambda: visitor.drawn()["instances"] > before, "wire frames are drawn")
    visitor.tick("Collision")
    visitor.wait_until(lambda: nothing_but_faces_is_drawn(visitor), "no wire frames are drawn")


def nothing_but_faces_is_drawn(visitor) -> bool:
    before = visitor.drawn()
    visitor.wait_until(lambda: visitor.drawn()["triangles"] > before["triangles"], "a frame")
    return visitor.drawn()["instances"] == before["instances"]


def test_controllers_are_deactivated_and_activated(visitor, client):
    from controller_manager_msgs.msg import ControllerManagerActivity
    from rclpy.qos import DurabilityPolicy, QoSProfile

    latched = QoSProfile(depth=1, durability=DurabilityPolicy.TRANSIENT_LOCAL)
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


def test_time_rates_and_the_node_graph_are_shown(visitor):
    visitor.open_tab("Control")
    factor = visitor.page.locator("tr", has_text="Real-time factor")
    visitor.wait_until(lambda: re.search(r"\d\.\d\d$", factor.inner_text()), "the time's factor")
    visitor.open_tab("System")
    visitor.tick("Rates")
    states = visitor.page.locator("tr", has_text="/joint_states")
    visitor.wait_until(lambda: re.search(r"\d\.\d Hz$", states.inner_text()), "a topic's rate")
    visitor.tick("Rates")
    visitor.tick("Node graph")
    node = visitor.page.locator("svg text", has_text="/joint_state_broadcaster").first
    node.wait_for()
    visitor.tick("Node graph")
    node.wait_for(state="hidden")
    visitor.open_tab("Robot")


def test_a_page_of_another_origin_is_refused(visitor, browser, page_url):
    address = page_url.replace("http:", "ws:")
    assert visitor.page.evaluate(OPEN_WEBSOCKET, address) == "accepted"
    foreign = browser.new_page()
    foreign.route("http://localhost:1/", lambda route: route.fulfill(body="<p>hello</p>"))
    foreign.goto("http://localhost:1/")
    assert foreign.evaluate(OPEN_WEBSOCKET, address) == "refused"
    foreign.close()


def test_the_page_goes_on_when_the_simulation_returns(visitor, simulation, launch_for_file, client):
    from sensor_msgs.msg import JointState

    banner = visitor.page.get_by_role("alert")
    banner.wait_for(state="hidden")
    assert simulation.stop() == 0, simulation.output
    banner.get_by_text("The simulation went away").wait_for()
    launch_for_file("camera:=none").wait_until_ready()
    banner.wait_for(state="hidden")
    states = client.subscribe(JointState, "/joint_states")

    def moved() -> bool:
        # A slider returns to its joint that does not follow: then it can be pulled again.
        visitor.slider("j0").press("Home")
        return states.wait_for()[-1].position[0] < -2.4

    visitor.wait_until(moved, "a slider moves the arm again")
