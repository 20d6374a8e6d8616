"""Sensors of one robot over real ROS: cameras of each type, IMU, force-torque, contact."""

from typing import Any

import numpy as np
import pytest
import yaml
from geometry_msgs.msg import WrenchStamped
from sensor_msgs.msg import CameraInfo, Image, Imu, PointCloud2
from std_msgs.msg import Bool, Float64MultiArray

PATIENCE_S = 90.0
G = 9.81
IMU = [
    *(f"orientation.{axis}" for axis in "xyzw"),
    *(
        f"{vector}.{axis}"
        for vector in ("angular_velocity", "linear_acceleration")
        for axis in "xyz"
    ),
]
WRENCH = [f"{vector}.{axis}" for vector in ("force", "torque") for axis in "xyz"]


def interfaces(names: list[str]) -> str:
    return "".join(f'<state_interface name="{name}"/>' for name in names)


def camera(name: str, kind: str, rate_hz: int, width: int) -> str:
    return (
        f'<gazebo reference="eye"><sensor name="{name}" type="{kind}">'
        f"<update_rate>{rate_hz}</update_rate><camera><image><width>{width}</width>"
        "<height>48</height></image></camera></sensor></gazebo>"
    )


BOX = '<geometry><box size="0.1 0.1 0.1"/></geometry>'
URDF = f"""
<robot name="lab">
  <link name="world"/>
  <link name="base"><visual>{BOX}</visual></link>
  <joint name="fix" type="fixed"><parent link="world"/><child link="base"/>
    <origin xyz="0 0 0.2"/></joint>
  <link name="arm">
    <inertial><origin xyz="0.3 0 0"/><mass value="1"/>
      <inertia ixx="0.01" ixy="0" ixz="0" iyy="0.01" iyz="0" izz="0.01"/></inertial>
    <collision><origin xyz="0.3 0 0"/>{BOX}</collision>
  </link>
  <joint name="j" type="revolute"><parent link="base"/><child link="arm"/><axis xyz="0 1 0"/>
    <limit lower="-3" upper="3" effort="50" velocity="5"/></joint>
  <link name="eye"/>
  <joint name="e" type="fixed"><parent link="world"/><child link="eye"/>
    <origin xyz="-1 0 0.2"/></joint>
  <link name="eye_optical"/>
  <joint name="o" type="fixed"><parent link="eye"/><child link="eye_optical"/>
    <origin rpy="-1.5707963 0 -1.5707963"/></joint>
  <ros2_control name="sim" type="system"><hardware><plugin>any/Plugin</plugin></hardware>
    <joint name="j"><command_interface name="position"/><state_interface name="position"/></joint>
    <sensor name="imu">{interfaces(IMU)}</sensor>
    <sensor name="wrist">{interfaces(WRENCH)}</sensor>
  </ros2_control>
  <gazebo reference="arm"><sensor name="imu" type="imu"><topic>imu/data</topic>
    <update_rate>50</update_rate></sensor></gazebo>
  <gazebo reference="arm"><sensor name="bumper" type="contact"/></gazebo>
  <gazebo reference="j"><sensor name="wrist" type="force_torque"/></gazebo>
  {camera("plain", "camera", 20, 64)}
  {camera("front", "rgbd_camera", 10, 96)}
  {camera("ranger", "depth_camera", 5, 32)}
</robot>
"""
SPAWNED = ("position_controller", "imu_broadcaster", "ft_broadcaster")
CONTROLLERS = """
controller_manager:
  ros__parameters:
    update_rate: 100
    position_controller: {type: position_controllers/JointGroupPositionController}
    imu_broadcaster: {type: imu_sensor_broadcaster/IMUSensorBroadcaster}
    ft_broadcaster: {type: force_torque_sensor_broadcaster/ForceTorqueSensorBroadcaster}
position_controller: {ros__parameters: {joints: [j]}}
imu_broadcaster: {ros__parameters: {sensor_name: imu, frame_id: arm}}
ft_broadcaster: {ros__parameters: {sensor_name: wrist, frame_id: tool}}
"""


@pytest.fixture(scope="module")
def lab(simulate):
    """A robot with all kinds of sensors, running; its boxes' faces are 0.95 m from its cameras."""
    settings = {"robot_description": URDF, "spawn": ",".join(SPAWNED)}
    nodes = {node: v["ros__parameters"] for node, v in yaml.safe_load(CONTROLLERS).items()}
    simulate({"arm_gazebo": settings, **nodes}).wait_for_line(f"activated {SPAWNED[-1]}")


def stamp_ns(message) -> int:
    return message.header.stamp.sec * 10**9 + message.header.stamp.nanosec


def vector(message) -> list[float]:
    return [message.x, message.y, message.z]


def common(first, second) -> list:
    """Return the pairs of messages of two topics that have the same stamp."""
    by_stamp = {stamp_ns(message): message for message in list(second.messages)}
    pairs = ((message, by_stamp.get(stamp_ns(message))) for message in list(first.messages))
    return [pair for pair in pairs if pair[1] is not None]


def test_the_imu_and_its_broadcaster_publish_the_same_state(lab, client):
    own = client.subscribe(Imu, "/imu/data")
    broadcast = client.subscribe(Imu, "/imu_broadcaster/imu")
    client.wait_until(lambda: common(own, broadcast), "the same stamp on both topics", PATIENCE_S)
    message, other = common(own, broadcast)[-1]
    assert vector(message.linear_acceleration) == pytest.approx([0, 0, G], abs=0.01)
    assert message.header.frame_id == "arm"
    assert vector(message.linear_acceleration) == vector(other.linear_acceleration)
    assert message.orientation == other.orientation
    # 50 Hz of simulation time at 100 ticks a second: every second tick.
    assert {stamp_ns(m) % 20_000_000 for m in own.messages} == {0}


def test_a_force_torque_sensor_measures_the_weight_of_the_arm(lab, client):
    for topic, frame in (("/wrist", "arm"), ("/ft_broadcaster/wrench", "tool")):
        (message, *_) = client.subscribe(WrenchStamped, topic).wait_for(1, PATIENCE_S)
        assert message.header.frame_id == frame
        assert vector(message.wrench.force) == pytest.approx([0, 0, -G], abs=0.01)
        assert message.wrench.torque.y == pytest.approx(0.3 * G, abs=0.01)


@pytest.mark.parametrize(
    ("topic", "info", "width"),
    [("/front/depth_image", "/front/camera_info", 96), ("/ranger", "/ranger/camera_info", 32)],
)
def test_depth_is_in_metres_and_comes_with_its_camera_info(lab, client, topic, info, width):
    images, infos = client.subscribe(Image, topic), client.subscribe(CameraInfo, info)
    client.wait_until(lambda: common(images, infos), "an image and its info", PATIENCE_S)
    image, about = common(images, infos)[-1]
    assert (image.encoding, image.width, image.height) == ("32FC1", width, 48)
    assert (about.width, about.height) == (width, 48)
    assert image.header.frame_id == about.header.frame_id == "eye_optical"
    depth = np.frombuffer(image.data, np.float32).reshape(48, width)
    assert depth[24, width // 2] == pytest.approx(0.95, abs=1e-3)
    assert depth[0, 0] == np.inf


def test_points_have_position_and_colour(lab, client):
    clouds = client.subscribe(PointCloud2, "/front/points")
    images = client.subscribe(Image, "/front/image")
    client.wait_until(
        lambda: common(clouds, images), "points and a picture of one state", PATIENCE_S
    )
    cloud, image = common(clouds, images)[-1]
    assert cloud.header.frame_id == "eye_optical"
    assert [field.name for field in cloud.fields] == ["x", "y", "z", "rgb"]
    assert (cloud.width, cloud.height, cloud.point_step) == (96, 48, 16)
    points = np.frombuffer(cloud.data, np.uint8).reshape(48, 96, 16)
    middle = points[24, 48]
    assert middle[:12].view(np.float32)[2] == pytest.approx(0.95, abs=1e-3)
    pixels = np.frombuffer(image.data, np.uint8).reshape(48, 96, 3)
    assert middle[12:15].tolist() == pixels[24, 48, ::-1].tolist()


def test_a_plain_camera_beside_them_has_its_own_size_and_rate(lab, client):
    images = client.subscribe(Image, "/plain").wait_for(3, PATIENCE_S)
    assert {(image.width, image.height, image.encoding) for image in images} == {(64, 48, "rgb8")}
    assert {stamp_ns(image) % 50_000_000 for image in images} == {0}


def test_contact_is_published_when_the_arm_touches_down(lab, client):
    states = client.subscribe(Bool, "/bumper/in_contact")
    forces = client.subscribe(WrenchStamped, "/bumper")
    assert not states.wait_for(1, PATIENCE_S)[0].data
    commands = client.publisher(Float64MultiArray, "/position_controller/commands")

    def pressed() -> Any:
        commands.publish(Float64MultiArray(data=[0.6]))
        force = forces.messages[-1].wrench.force if forces.messages else None
        touched = any(m.data for m in states.messages)
        return force if touched and force and np.linalg.norm(vector(force)) > 1.0 else None

    force: Any = client.wait_until(pressed, "the floor is touched", PATIENCE_S)
    # The floor pushes up, and the arm has turned: z is still the most of it.
    assert force.z > 0
