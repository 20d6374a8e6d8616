"""The page beside an arm with a camera in its hand, and a crate that rests on the floor."""

import math

import numpy as np
import pytest
from page_user import DESK, PHONE, PageUser
from robots import box, control, crate, joint, link, robot, sensor
from simulated import Simulated
from std_msgs.msg import Float64MultiArray

pytestmark = pytest.mark.timeout(600)

REACH_M, HEIGHT_M = 0.3, 0.4
IMAGE = "<image><width>64</width><height>48</height></image>"
ARM = robot(
    link("base", box("visual", size=0.05)),
    link("hand", box("visual", size=0.02), mass=0.1),
    link("lens", mass=0.0),
    joint("turn", "base", "hand", axis="0 0 1", xyz=f"0 0 {HEIGHT_M}"),
    "<joint name='mount' type='fixed'><parent link='hand'/><child link='lens'/>"
    f"<origin xyz='{REACH_M} 0 0' rpy='-1.5707963 0 -1.5707963'/></joint>",
    sensor(
        "hand",
        "eye",
        "camera",
        f"<pose>{REACH_M} 0 0 0 0 0</pose><topic>/eye</topic><update_rate>10</update_rate>",
        f"<camera>{IMAGE}<optical_frame_id>lens</optical_frame_id></camera>",
    ),
    control(
        "<joint name='turn'><command_interface name='position'/><state_interface name='position'/>"
        "</joint>"
    ),
)
CONTROLLERS = """
controller_manager:
  ros__parameters:
    update_rate: 100
    joint_state_broadcaster: {type: joint_state_broadcaster/JointStateBroadcaster}
    arm: {type: position_controllers/JointGroupPositionController}
arm: {ros__parameters: {joints: [turn]}}
"""
CRATE_M, PUSHED_UP_N = (0.5, 0.0, 0.05), 9.81
EYE = "() => window.__viserMutable.camera.position.toArray()"
SIZES = {"desk": DESK, "phone": PHONE}


@pytest.fixture(scope="module")
def simulation(launch_for_file, tmp_path_factory):
    """Return the running simulation of the arm, with its page."""
    folder = tmp_path_factory.mktemp("hand")
    (folder / "arm.urdf").write_text(ARM)
    (folder / "controllers.yaml").write_text(CONTROLLERS)
    launched = launch_for_file(
        *("arm_gazebo", "sim.launch.py", f"model:={folder / 'arm.urdf'}"),
        *(f"controllers:={folder / 'controllers.yaml'}", "spawn:=joint_state_broadcaster,arm"),
        *("viewer:=true", "viewer_port:=0"),
    )
    launched.wait_until_ready()
    return launched


@pytest.fixture(scope="module")
def page_url(simulation) -> str:
    """Return the address of the page."""
    line = simulation.wait_for_line("the page is at http://")
    return line[line.index("http://") :].strip()


@pytest.fixture(scope="module")
def crate_on_the_floor(simulation, client_for_file):
    Simulated(client_for_file).spawn("crate", crate(), *CRATE_M[:2], 0.06)


@pytest.fixture(scope="module", params=SIZES)
def user(request, page_at, page_url):
    """Return a user of the page in a window of each size."""
    page = page_at(page_url, viewport=SIZES[request.param])
    yield PageUser(page)
    page.close()


@pytest.fixture
def turn(client_for_file, user):
    """Return a function that turns the arm; a message may be lost, so it is sent again."""
    publisher = client_for_file.publisher(Float64MultiArray, "/arm/commands")

    def turn_to(angle: float, until, what: str) -> None:
        def sent() -> bool:
            publisher.publish(Float64MultiArray(data=[angle]))
            return until()

        user.wait_until(sent, what)

    return turn_to


def test_the_forces_on_a_resting_crate_are_shown(user, crate_on_the_floor):
    assert (user.contacts(), user.forces()) == ([], [])
    user.switch("Contacts", True)
    user.page.get_by_text("crate::base on world: 9.8").wait_for(state="attached")
    # The crate is 0.1 m wide; it stands with its corners on the floor.
    user.wait_until(lambda: len(user.contacts()) == 4, "its four corners are drawn")
    corners = np.abs(np.array(user.contacts()) - (CRATE_M[0], CRATE_M[1], 0.0))
    assert corners == pytest.approx(np.tile((0.05, 0.05, 0.0), (4, 1)), abs=0.002)
    lines = np.array(user.forces())
    lengths_m = lines[:, 5] - lines[:, 2]
    assert lengths_m.sum() == pytest.approx(0.02 * PUSHED_UP_N, rel=0.02), "2 cm a newton, upwards"
    user.switch("Contacts", False)
    user.wait_until(lambda: not user.contacts() and not user.forces(), "they are hidden")


def test_the_view_follows_the_camera_in_the_hand(user, turn):
    def looks_from(angle: float) -> bool:
        # In three.js's axes: x is the world's -y, y is up, and z is the world's -x.
        wanted = (-REACH_M * math.sin(angle), HEIGHT_M, -REACH_M * math.cos(angle))
        return np.allclose(user.page.evaluate(EYE), wanted, atol=0.005)

    def slider() -> float:
        found = user.page.locator("xpath=//label[.='turn']/following::*[@role='slider'][1]")
        return float(found.get_attribute("aria-valuenow"))

    if user.page.viewport_size == PHONE:
        # There the section is folded at first.
        user.page.locator("p:text-is('Cameras')").click()
    user.click("Look from here")
    turn(0.0, lambda: looks_from(0.0), "it looks from the hand")
    user.page.get_by_text("View from /eye").wait_for()
    assert user.is_whole("arm-view-from")
    turn(1.2, lambda: looks_from(1.2), "the view turns with the arm")
    turn(-1.2, lambda: not looks_from(1.2), "it turns back")
    # While it is on its way, poses wait for the next frame: they must not take the view back.
    user.click("Free camera")
    user.page.locator("#arm-view-from").wait_for(state="hidden")
    turn(-1.2, lambda: abs(slider() + 1.2) < 0.01, "the arm goes on")
    free = user.page.evaluate(EYE)
    assert math.hypot(free[0], free[2]) > REACH_M + 0.1, "the view from before"
    turn(0.0, lambda: abs(slider()) < 0.01, "and on")
    assert user.page.evaluate(EYE) == pytest.approx(free, abs=1e-3)
