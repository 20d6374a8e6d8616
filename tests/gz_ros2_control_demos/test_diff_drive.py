"""The robot on two wheels: where it says it is, and where it is."""

from math import atan2, hypot, pi

import numpy as np
import pytest

from arm_control.controllers.diff_drive.odometry import PlanarPose, PlanarTwist
from arm_description import expand_xacro, forward_kinematics, parse_urdf, resolve_uri

DRIVE = "diff_drive_base_controller"


class Odometry:
    """What the controller says of the robot."""

    def __init__(self) -> None:
        self.pose = PlanarPose()
        self.twist = PlanarTwist()

    def publish_odometry(self, time_s: float, pose: PlanarPose, twist: PlanarTwist) -> None:
        self.pose, self.twist = pose, twist

    def publish_command(self, time_s: float, twist: PlanarTwist) -> None:
        """Not looked at."""


class Robot:
    """The demo with a listener."""

    def __init__(self, demo, model_args: str = "", model: str = "diff_drive.urdf.xacro") -> None:
        self.demo = demo(model, model_args, "diff_drive_controller.yaml", "free")
        self.drive = self.demo.controllers[DRIVE]
        self.drive.sink = self.odometry = Odometry()
        self.demo.run(1.0)

    def go(self, linear: float, angular: float, seconds: float) -> None:
        self.demo.run(seconds, lambda: self.drive.offer(PlanarTwist(linear, angular), None))

    def stop(self) -> None:
        self.demo.run(1.5)

    @property
    def pose(self) -> tuple[float, float, float]:
        """Where the simulation has it."""
        place, rotation = self.demo.body("base_link")
        return place[0], place[1], atan2(rotation[1, 0], rotation[0, 0])


def wrapped(angle: float) -> float:
    return (angle + pi) % (2 * pi) - pi


@pytest.mark.parametrize(
    ("linear", "angular", "seconds"),
    [(0.2, 0.5, 6.0), (0.5, 0.0, 4.0), (-0.3, 0.4, 5.0), (0.0, 1.0, 6.0)],
    ids=["curve", "straight", "backwards", "on the spot"],
)
def test_odometry_agrees_with_where_the_robot_is(demo, linear, angular, seconds):
    robot = Robot(demo)
    x0, y0, heading0 = robot.pose
    robot.go(linear, angular, seconds)
    robot.stop()
    x, y, heading = robot.pose
    told = robot.odometry.pose
    way = max(abs(linear), abs(angular) * 0.18) * seconds
    assert hypot(told.x - (x - x0), told.y - (y - y0)) < 0.015 * way
    assert abs(wrapped(told.heading - (heading - heading0))) < 0.015 * max(1.0, angular * seconds)


WHEEL = """<link name="{side}_wheel"><inertial><mass value="0.5"/><inertia ixx="1e-3" iyy="2.5e-3"
  izz="1e-3" ixy="0" ixz="0" iyz="0"/></inertial><collision><origin rpy="1.5707963 0 0"/><geometry>
  <cylinder radius="0.1" length="{width}"/></geometry></collision></link>
  <joint name="{side}_wheel_joint" type="continuous"><parent link="base_link"/>
  <child link="{side}_wheel"/><origin xyz="0 {y} 0"/><axis xyz="0 1 0"/>
  <limit effort="10" velocity="30"/></joint>"""
CASTER = """<link name="caster"><inertial><mass value="0.1"/><inertia ixx="1e-4" iyy="1e-4"
  izz="1e-4" ixy="0" ixz="0" iyz="0"/></inertial><collision><geometry>
  <sphere radius="0.04"/></geometry></collision></link>
  <joint name="caster_joint" type="fixed"><parent link="base_link"/>
  <child link="caster"/><origin xyz="-0.16 0 -0.06"/></joint>"""

SWIVEL = """<link name="fork"><inertial><mass value="0.1"/><inertia ixx="1e-4" iyy="1e-4" izz="1e-4"
  ixy="0" ixz="0" iyz="0"/></inertial></link><joint name="swivel" type="continuous">
  <parent link="base_link"/><child link="fork"/><origin xyz="-0.16 0 -0.03"/><axis xyz="0 0 1"/>
  </joint><link name="roll"><inertial><mass value="0.1"/><inertia ixx="1e-4" iyy="1e-4" izz="1e-4"
  ixy="0" ixz="0" iyz="0"/></inertial><collision><origin rpy="1.5707963 0 0"/><geometry>
  <cylinder radius="0.04" length="0.02"/></geometry></collision></link>
  <joint name="roll_joint" type="continuous"><parent link="fork"/><child link="roll"/>
  <origin xyz="-0.03 0 -0.03"/><axis xyz="0 1 0"/></joint>"""


def made_up(width: float, caster: str) -> str:
    """Return a robot on two cylinders and a caster that nobody made slippery: friction 1."""
    interfaces = '<command_interface name="velocity"/><state_interface name="position"/>'
    joints = "".join(
        f'<joint name="{side}_wheel_joint">{interfaces}</joint>' for side in ("left", "right")
    )
    return (
        '<robot name="cart" xmlns:xacro="http://www.ros.org/wiki/xacro">'
        '<xacro:arg name="prefix" default=""/>'
        '<link name="base_link"><inertial><origin xyz="-0.05 0 0.02"/>'
        '<mass value="5"/><inertia ixx="0.04" iyy="0.08" izz="0.11" ixy="0" ixz="0" iyz="0"/>'
        "</inertial></link>"
        + WHEEL.format(side="left", y=0.18, width=width)
        + WHEEL.format(side="right", y=-0.18, width=width)
        + caster
        + '<ros2_control name="c" type="system"><hardware><plugin>arm_gazebo/SimulatedHardware'
        f"</plugin></hardware>{joints}</ros2_control></robot>"
    )


@pytest.mark.parametrize(
    ("width", "caster"),
    [(0.04, CASTER), (0.12, CASTER), (0.04, SWIVEL)],
    ids=["ball", "wide", "swivel"],
)
@pytest.mark.parametrize(
    ("linear", "angular", "seconds"),
    [(0.0, 1.0, 6.0), (0.3, 0.5, 6.0), (-0.3, 0.4, 5.0), (0.5, 0.0, 4.0)],
    ids=["on the spot", "arc", "backwards", "straight"],
)
def test_odometry_of_a_plain_robot_agrees_too(
    demo, tmp_path, width, caster, linear, angular, seconds
):
    """Wide wheels stand on their middle, and a caster that is dragged does not hop."""
    file = tmp_path / "cart.urdf.xacro"
    file.write_text(made_up(width, caster))
    robot = Robot(demo, model=str(file))
    x0, y0, heading0 = robot.pose
    robot.go(linear, angular, seconds)
    robot.stop()
    x, y, heading = robot.pose
    told = robot.odometry.pose
    way = max(abs(linear), abs(angular) * 0.18) * seconds
    assert hypot(told.x - (x - x0), told.y - (y - y0)) < 0.03 * way
    assert abs(wrapped(told.heading - (heading - heading0))) < 0.03 * max(0.5, angular * seconds)


def test_it_goes_as_fast_as_it_is_told_and_stays_upright(demo):
    robot = Robot(demo)
    x0, *_ = robot.pose
    robot.go(0.4, 0.0, 3.0)
    assert robot.odometry.twist.linear == pytest.approx(0.4, rel=0.02)
    place, rotation = robot.demo.body("base_link")
    # The acceleration of 1 m/s2 costs it 0.08 m.
    assert place[0] - x0 == pytest.approx(1.2 - 0.08, abs=0.04)
    assert place[2] == pytest.approx(0.1, abs=0.005)
    assert rotation[2, 2] > 0.999


def test_a_full_circle_brings_it_back(demo):
    robot = Robot(demo)
    x0, y0, _ = robot.pose
    robot.go(0.2, 0.5, 4 * pi)
    robot.go(0.0, 0.0, 1.0)
    x, y, heading = robot.pose
    assert hypot(x - x0, y - y0) < 0.03 * (0.2 * 4 * pi)
    assert abs(wrapped(heading)) < 0.03 * 2 * pi


def test_it_stops_without_further_commands(demo):
    robot = Robot(demo)
    robot.go(0.5, 0.5, 2.0)
    robot.stop()
    before = np.array(robot.pose)
    robot.demo.run(2.0)
    assert np.array(robot.pose) == pytest.approx(before, abs=1e-3)
    assert robot.odometry.twist.linear == pytest.approx(0.0, abs=1e-3)


def test_the_wheels_are_as_large_and_as_far_apart_as_the_controller_thinks(demo):
    robot = Robot(demo)
    geometry = robot.drive.parameters.geometry
    model = expand_xacro(resolve_uri("package://gz_ros2_control_demos/urdf/diff_drive.urdf.xacro"))
    description = parse_urdf(model)
    (collision,) = description.link("left_wheel").collisions
    frames = forward_kinematics(description, {})
    apart = frames["left_wheel"][1, 3] - frames["right_wheel"][1, 3]
    assert geometry.left_radius == geometry.right_radius == collision.geometry.radius
    assert geometry.separation == pytest.approx(apart)


def test_a_prefix_reaches_the_controllers_file(demo):
    robot = Robot(demo, "prefix:=left_")
    parameters = robot.drive.parameters
    assert parameters.left_wheel_names == ("left_left_wheel_joint",)
    assert parameters.base_frame_id == "left_base_link"
