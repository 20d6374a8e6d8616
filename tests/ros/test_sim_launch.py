"""`arm launch arm_gazebo sim.launch.py` with robots that are unknown to this suite."""

import numpy as np
import pytest
from controller_manager_msgs.srv import ListControllers
from robots import TETRAHEDRON_OBJ
from sensor_msgs.msg import Image, JointState
from std_msgs.msg import Float64MultiArray, String

from arm_description import ResourceFinder

FRAME = '<link name="base_link"/><link name="upper"/><link name="lower"/>'
LIMIT = '<limit lower="-2" upper="2" effort="20" velocity="2"/>'
XACRO = 'xmlns:xacro="http://www.ros.org/wiki/xacro"'
JOINTS = f"""
<joint name="shoulder" type="revolute"><parent link="base_link"/><child link="upper"/>
  <origin xyz="0 0 1"/><axis xyz="0 1 0"/>{LIMIT}</joint>
<joint name="elbow" type="revolute"><parent link="upper"/><child link="lower"/>
  <origin xyz="0 0 0.3"/><axis xyz="0 1 0"/>{LIMIT}</joint>
"""


@pytest.fixture
def bare(tmp_path):
    """The file of a robot without a <ros2_control> block."""
    model = tmp_path / "bare.urdf"
    model.write_text(f'<robot name="bare">{FRAME}{JOINTS}</robot>')
    return model


@pytest.fixture
def sdf_world(tmp_path):
    """The file of a world that includes a model from the folder `models` beside it."""
    can = tmp_path / "models" / "can" / "model.sdf"
    can.parent.mkdir(parents=True)
    can.write_text('<sdf version="1.7"><model name="can"><static>1</static></model></sdf>')
    world = tmp_path / "lab.sdf"
    world.write_text(
        '<sdf version="1.7"><world name="lab"><plugin name="p" filename="f"/>'
        "<include><uri>model://can</uri></include></world></sdf>"
    )
    return world


def test_a_robot_without_hardware_and_controllers_moves(launch, client, bare, sdf_world):
    launched = launch(
        "arm_gazebo",
        "sim.launch.py",
        f"model:={bare}",
        "namespace:=left",
        f"gz_args:=-r {sdf_world}",
        f"resource_path:={sdf_world.parent / 'models'}",
    )
    launched.wait_until_ready()
    launched.wait_for_line("plugin 'p' in lab.sdf (line 1): it is not simulated")
    remark = "world lab: 1 thing is left out: plugin 'p' in lab.sdf"
    launched.wait_for_line(f"[arm_gazebo]: {remark}")
    launched.wait_for_line(f"arm_gazebo_node: {remark}")
    launched.wait_for_line("a default one commands shoulder, elbow")
    states = client.subscribe(JointState, "/left/joint_states")
    commands = client.publisher(Float64MultiArray, "/left/position_controller/commands")
    commands.publish(Float64MultiArray(data=[0.5, -0.5]))
    goal = {"shoulder": 0.5, "elbow": -0.5}
    reached = states.wait_until(
        lambda m: (
            bool(m) and np.allclose(m[-1].position, [goal[name] for name in m[-1].name], atol=0.005)
        ),
        "the pose is reached",
    )
    assert set(reached[-1].name) == goal.keys()


def test_a_user_s_package_is_not_shadowed_by_the_suite_s_package_of_that_name(
    launch, client, tmp_path, latched
):
    package = tmp_path / "arm_description"
    (package / "meshes").mkdir(parents=True)
    (package / "package.xml").write_text("<package><name>arm_description</name></package>")
    (package / "meshes/wedge.obj").write_text(TETRAHEDRON_OBJ)
    uris = ("package://arm_description/meshes/wedge.obj", "meshes/wedge.obj")
    shapes = "".join(
        f'<visual><geometry><mesh filename="{uri}"/></geometry></visual>' for uri in uris
    )
    (package / "bare.urdf").write_text(
        f'<robot name="bare">{FRAME}{JOINTS}</robot>'.replace(
            '<link name="upper"/>', f'<link name="upper">{shapes}</link>'
        )
    )
    launched = launch(
        "arm_gazebo", "sim.launch.py", f"model:={package / 'bare.urdf'}", "strict:=true"
    )
    launched.wait_until_ready()
    description = client.subscribe(String, "/robot_description", latched).wait_for(1)[-1].data
    finder = ResourceFinder.of_description(description)
    assert {finder.find(uri) for uri in uris} == {package / "meshes/wedge.obj"}


def test_a_mast_s_camera_publishes_pictures(launch, client, tmp_path):
    """Nothing on the mast moves, so it needs no controller."""
    mast = tmp_path / "mast.urdf"
    mast.write_text(
        '<robot name="mast"><link name="foot"/><link name="top"/>'
        '<joint name="pole" type="fixed"><parent link="foot"/><child link="top"/>'
        '<origin xyz="0 0 1"/></joint><gazebo reference="top"><sensor name="eye" type="camera">'
        "<update_rate>10</update_rate><camera><image><width>64</width>"
        "<height>48</height></image></camera></sensor></gazebo></robot>"
    )
    launched = launch("arm_gazebo", "sim.launch.py", f"model:={mast}")
    launched.wait_until_ready()
    assert client.subscribe(Image, "/eye").wait_for(1)[-1].width == 64
    assert "does not start" not in launched.output


FOREIGN = """
controller_manager:
  ros__parameters:
    states: {type: joint_state_broadcaster/JointStateBroadcaster}
    force: {type: force_torque_sensor_broadcaster/ForceTorqueSensorBroadcaster}
    gripper: {type: position_controllers/JointGroupPositionController}
force: {ros__parameters: {sensor_name: only_real, frame_id: lower}}
gripper: {ros__parameters: {joints: [finger]}}
arm:
  ros__parameters:
    type: position_controllers/JointGroupPositionController
    joints: [shoulder, elbow]
"""


@pytest.fixture
def foreign(tmp_path):
    """A file of controllers, two of them for what the robot does not have."""
    file = tmp_path / "foreign.yaml"
    file.write_text(FOREIGN)
    return file


def test_controllers_that_do_not_fit_the_robot_are_left_out(launch, client, bare, foreign):
    launched = launch("arm_gazebo", "sim.launch.py", f"model:={bare}", f"controllers:={foreign}")
    launched.wait_until_ready()
    launched.wait_for_line("force does not start: Unable to activate controller 'force' since the")
    launched.wait_for_line("gripper does not start: Unable to activate controller 'gripper' since")
    service = "/controller_manager/list_controllers"
    listed = client.call(ListControllers, service, ListControllers.Request()).controller
    assert {c.name for c in listed if c.state == "active"} == {"states", "arm"}


def test_a_named_controller_must_start(launch, bare, foreign):
    launched = launch(
        *("arm_gazebo", "sim.launch.py", f"model:={bare}"),
        *(f"controllers:={foreign}", "spawn:=states,force"),
    )
    assert launched.wait() != 0
    assert "[FATAL]" in launched.output
    assert "'only_real/force.x' is not available" in launched.output


def test_two_robots_in_one_world_do_not_affect_each_other(launch, client, tmp_path):
    text = f'<robot name="$(arg p)" {XACRO}><xacro:arg name="p" default=""/>{FRAME}{JOINTS}</robot>'
    for name in ("base_link", "upper", "lower", "shoulder", "elbow"):
        text = text.replace(f'"{name}"', f'"$(arg p){name}"')
    (tmp_path / "arm.xacro").write_text(text)
    robots = tmp_path / "robots.yaml"
    robots.write_text(
        "left: {model: arm.xacro, model_args: 'p:=left_'}\n"
        "right: {model: arm.xacro, model_args: 'p:=right_', pose: [0, 0.5, 0, 0, 0, 0]}\n"
    )
    launch("arm_gazebo", "sim.launch.py", f"robots:={robots}").wait_until_ready()
    left = client.subscribe(JointState, "/left/joint_states")
    right = client.subscribe(JointState, "/right/joint_states")
    client.publisher(Float64MultiArray, "/left/position_controller/commands").publish(
        Float64MultiArray(data=[0.6, 0.6])
    )
    moved = left.wait_until(
        lambda m: bool(m) and np.allclose(m[-1].position, 0.6, atol=0.005), "the left arm is there"
    )[-1]
    stood = right.wait_for(1)[-1]
    assert sorted(moved.name) == ["left_elbow", "left_shoulder"]
    assert sorted(stood.name) == ["right_elbow", "right_shoulder"]
    assert np.allclose(stood.position, 0.0, atol=0.005)
    service = "/right/controller_manager/list_controllers"
    listed = client.call(ListControllers, service, ListControllers.Request()).controller
    claimed = {name for controller in listed for name in controller.claimed_interfaces}
    assert claimed == {"right_shoulder/position", "right_elbow/position"}


def test_a_model_that_is_not_a_robot_is_reported(launch, tmp_path):
    model = tmp_path / "two.urdf"
    model.write_text('<robot name="two"><link name="a"/>\n<link name="b"/></robot>')
    launched = launch("arm_gazebo", "sim.launch.py", f"model:={model}")
    assert launched.wait() != 0
    assert "'a' (line 1), 'b' (line 2)" in launched.output
    assert "Traceback" not in launched.output
