"""The page beside two robots in one world, and a third one that is only displayed."""

import pytest
from controller_manager_msgs.srv import LoadController, SwitchController
from sensor_msgs.msg import JointState
from std_msgs.msg import String

pytestmark = pytest.mark.timeout(600)

ARM = """<robot name="$(arg p)arm" xmlns:xacro="http://www.ros.org/wiki/xacro">
<xacro:arg name="p" default=""/>
<link name="$(arg p)base"/><link name="$(arg p)upper"/><link name="$(arg p)thumb"/>
<link name="$(arg p)finger"/>
<joint name="$(arg p)shoulder" type="revolute"><parent link="$(arg p)base"/>
  <child link="$(arg p)upper"/><origin xyz="0 0 0.4"/><axis xyz="0 0 1"/>
  <limit lower="-2" upper="2" effort="20" velocity="2"/></joint>
<joint name="$(arg p)grip" type="prismatic"><parent link="$(arg p)upper"/>
  <child link="$(arg p)thumb"/><origin xyz="0 0 0.3"/><axis xyz="0 1 0"/>
  <limit lower="0" upper="0.04" effort="20" velocity="0.2"/></joint>
<joint name="$(arg p)other_grip" type="prismatic"><parent link="$(arg p)upper"/>
  <child link="$(arg p)finger"/><origin xyz="0 0 0.3"/><axis xyz="0 -1 0"/>
  <limit lower="0" upper="0.04" effort="20" velocity="0.2"/><mimic joint="$(arg p)grip"/></joint>
</robot>"""
CONTROLLERS = """
controller_manager:
  ros__parameters:
    update_rate: 50
    joint_state_broadcaster: {type: joint_state_broadcaster/JointStateBroadcaster}
    arm_controller: {type: position_controllers/JointGroupPositionController}
    gripper: {type: parallel_gripper_action_controller/GripperActionController}
    spare: {type: position_controllers/JointGroupPositionController}
arm_controller: {ros__parameters: {joints: ["${p}shoulder"]}}
gripper: {ros__parameters: {joint: "${p}grip"}}
spare: {ros__parameters: {joints: ["${p}shoulder"]}}
"""
DISPLAYED = """<robot name="ghost"><link name="a"/><link name="b">
  <visual><geometry><mesh filename="package://nowhere/b.stl"/></geometry></visual></link>
<joint name="ghost_turn" type="revolute"><parent link="a"/><child link="b"/>
  <limit lower="1" upper="3" effort="1" velocity="1"/></joint></robot>"""


@pytest.fixture(scope="module")
def simulation(launch_for_file, tmp_path_factory):
    """Return two running robots, and the page of this file."""
    folder = tmp_path_factory.mktemp("robots")
    (folder / "arm.urdf.xacro").write_text(ARM)
    (folder / "controllers.yaml").write_text(CONTROLLERS)
    common = (
        "model: arm.urdf.xacro, controllers: controllers.yaml, "
        "spawn: 'joint_state_broadcaster,arm_controller,gripper'"
    )
    (folder / "robots.yaml").write_text(
        f"left: {{{common}, model_args: 'p:=left_'}}\n"
        f"right: {{{common}, model_args: 'p:=right_', pose: [0, 0.8, 0, 0, 0, 0]}}\n"
    )
    launched = launch_for_file(
        *("arm_gazebo", "sim.launch.py", f"robots:={folder / 'robots.yaml'}"),
        *("viewer:=true", "viewer_port:=0", "publish_joint_states:=true"),
    )
    launched.wait_until_ready()
    return launched


@pytest.fixture(scope="module")
def page_url(simulation) -> str:
    """Return the address of the page."""
    line = simulation.wait_for_line("the page is at http://")
    return line[line.index("http://") :].strip()


@pytest.fixture
def positions(client):
    """Return a joint's newest position in a namespace, by a function."""
    states = {n: client.subscribe(JointState, f"{n}/joint_states") for n in ("/left", "/right", "")}

    def newest(namespace: str, joint: str) -> float:
        message = states[namespace].wait_for()[-1]
        return message.position[list(message.name).index(joint)]

    return newest


def test_a_slider_moves_the_joint_of_its_own_robot(visitor, positions):
    def moved() -> bool:
        visitor.slider("left_shoulder").press("End")
        return positions("/left", "left_shoulder") > 1.9

    visitor.wait_until(moved, "the left arm goes to its limit")
    assert abs(positions("/right", "right_shoulder")) < 0.01
    assert abs(visitor.slider_value("right_shoulder")) < 0.01
    assert visitor.errors == []


def test_a_slider_drives_a_gripper_and_shows_what_follows(visitor, positions):
    def opened() -> bool:
        visitor.slider("right_grip").press("End")
        return positions("/right", "right_grip") > 0.035

    visitor.wait_until(opened, "the right gripper opens")
    assert positions("/left", "left_grip") < 0.005
    follower = visitor.page.get_by_role("row", name="right_other_grip follows right_grip")
    visitor.wait_until(
        lambda: follower.get_by_role("cell").last.inner_text() == "0.040", "its finger is shown"
    )
    assert visitor.slider("right_other_grip").count() == 0


def test_a_loaded_controller_is_configured_then_activated(visitor, client):
    visitor.open_tab("Control")
    manager = "/left/controller_manager"
    load = LoadController.Request(name="spare")
    assert client.call(LoadController, f"{manager}/load_controller", load).ok
    visitor.controller_button("spare", "Configure").click()
    visitor.controller_button("spare", "Activate").wait_for()
    # It has the joint that the spare one wants; that it let go must be heard of first. Not by a
    # button: which of the two robots comes first on the page depends on who was found first.
    release = SwitchController.Request(deactivate_controllers=["arm_controller"], strictness=2)
    assert client.call(SwitchController, f"{manager}/switch_controller", release).ok
    visitor.controller_button("arm_controller", "Activate").wait_for()
    visitor.controller_button("spare", "Activate").click()
    visitor.controller_button("spare", "Deactivate").wait_for()
    visitor.open_tab("Robot")


def test_a_displayed_robot_is_centred_and_put_anywhere(visitor, client, positions, latched):
    client.node.create_publisher(String, "/robot_description", latched).publish(
        String(data=DISPLAYED)
    )
    visitor.page.get_by_text("link 'b': no file for 'package://nowhere/b.stl'").wait_for()
    visitor.button("Center").click()
    visitor.wait_until(lambda: positions("", "ghost_turn") == 2.0, "the joint is in its middle")
    visitor.button("Randomize").click()
    visitor.wait_until(lambda: positions("", "ghost_turn") != 2.0, "the joint is elsewhere")
    at = positions("", "ghost_turn")
    assert 1.0 <= at <= 3.0
    visitor.wait_until(
        lambda: abs(visitor.slider_value("ghost_turn") - at) < 0.01, "the slider follows"
    )


def test_a_screenshot_is_a_file_for_the_browser(visitor):
    with visitor.page.expect_download() as download:
        visitor.button("Screenshot").click()
    assert download.value.suggested_filename == "arm.png"
    assert download.value.path().read_bytes().startswith(b"\x89PNG")
