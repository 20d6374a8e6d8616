"""Copies of a robot on a grid, and what their controllers' parameters name."""

import pytest
from robots import joint, link, robot

from arm_description.urdf.parser import parse_urdf
from arm_gazebo.errors import SimSettingsError
from arm_gazebo.launching.robot_setup import set_up_robot
from arm_gazebo.launching.several_robots import (
    Grid,
    copies_of,
    read_copies,
    read_grid,
    robots_of_file,
)

CONTROLLERS = """
/lab/controller_manager:
  ros__parameters:
    arm: {type: joint_trajectory_controller/JointTrajectoryController}
    wheels: {type: diff_drive_controller/DiffDriveController}
/lab/arm:
  ros__parameters:
    joints: [shoulder]
    command_joints: [pid/shoulder]
    gains: {shoulder: {p: 1.0}}
    constraints.shoulder.goal: 0.1
    table: /shoulder/table.csv
/lab/wheels:
  ros__parameters: {base_frame_id: base_link, left_wheel_names: [left], wheel_radius: 0.1}
"""
ROBOT = robot(
    *(link(name, mass=0) for name in ("base_link", "tip")),
    joint("shoulder", "base_link", "tip", limits=(-1, 1), effort=1, velocity=1),
    name="6dof-arm",
)


@pytest.fixture
def setup(tmp_path):
    file = tmp_path / "controllers.yaml"
    file.write_text(CONTROLLERS)
    return set_up_robot(ROBOT, controllers=str(file))


def parameters_of(robot, node):
    return robot.setup.controllers[node]["ros__parameters"]


def test_copies_have_namespaces_prefixes_and_places_of_their_own(setup):
    robots = copies_of(setup, Grid(3, 0.5))
    assert list(robots) == ["robot_6dof_arm_0", "robot_6dof_arm_1", "robot_6dof_arm_2"]
    assert [robot.pose[:2] for robot in robots.values()] == [(0, 0), (0, 0.5), (0.5, 0)]
    for name, placed in robots.items():
        assert parse_urdf(placed.setup.description).joint(f"{name}_shoulder").child == f"{name}_tip"


def test_parameters_of_controllers_name_the_joints_of_the_copy(setup):
    robot = copies_of(setup, Grid(2, 1.0), namespace="/lab/")["lab_1"]
    arm = parameters_of(robot, "arm")
    assert arm["joints"] == ["lab_1_shoulder"]
    assert arm["command_joints"] == ["pid/lab_1_shoulder"]
    assert arm["gains"] == {"lab_1_shoulder": {"p": 1.0}}
    assert arm["constraints"] == {"lab_1_shoulder": {"goal": 0.1}}
    assert arm["table"] == "/shoulder/table.csv"
    assert "arm" in parameters_of(robot, "controller_manager")


def test_a_robot_of_a_file_gets_a_prefix_if_the_file_says_so(tmp_path):
    (tmp_path / "arm.urdf").write_text(ROBOT)
    (tmp_path / "controllers.yaml").write_text(CONTROLLERS)
    (tmp_path / "robots.yaml").write_text(
        "lab: {model: arm.urdf, controllers: controllers.yaml, prefix: true}\n"
        "bare: {model: arm.urdf, prefix: false}\n"
    )
    robots = robots_of_file(str(tmp_path / "robots.yaml"))
    joints = [parse_urdf(robots[name].setup.description).joints for name in ("lab", "bare")]
    assert [joint.name for (joint,) in joints] == ["lab_shoulder", "shoulder"]
    assert parameters_of(robots["lab"], "arm")["joints"] == ["lab_shoulder"]


def test_wheels_of_a_copy_have_an_odometry_frame_of_their_own(setup):
    wheels = parameters_of(copies_of(setup, Grid(2, 1.0), namespace="lab")["lab_1"], "wheels")
    assert wheels["base_frame_id"] == "lab_1_base_link"
    assert wheels["odom_frame_id"] == "lab_1_odom"
    assert wheels["tf_frame_prefix_enable"] is False


def test_a_free_copy_without_a_pose_stands_on_the_floor(setup):
    (robot,) = copies_of(setup, Grid(1, 1.0), "free").values()
    assert robot.parameters()["on_floor"] is True
    given = Grid(1, 1.0, (0.0, 0.0, 2.0, 0.0, 0.0, 0.0))
    (robot,) = copies_of(setup, given, "free").values()
    assert robot.parameters()["on_floor"] is False
    assert robot.parameters()["pose"][2] == 2.0


def test_a_grid_is_square_and_begins_at_the_pose():
    poses = read_grid(16, "0.8", "[1, 2, 3, 0, 0, 0.5]").poses()
    assert poses[0] == (1.0, 2.0, 3.0, 0.0, 0.0, 0.5)
    assert poses[-1] == pytest.approx((3.4, 4.4, 3.0, 0.0, 0.0, 0.5))
    assert len(set(poses)) == 16


@pytest.mark.parametrize("copies", ["0", "-1", "x", "1000", "2.5", "", "31", "٣", "1e1"])
def test_a_number_that_makes_no_sense_is_refused(copies):
    sentence = f"copies:={copies} is not a number of robots that one world can have"
    with pytest.raises(SimSettingsError, match=sentence):
        read_copies(copies, 30)


def test_numbers_up_to_the_limit_are_taken():
    assert [read_copies(text, 30) for text in ("1", "30", " 4 ")] == [1, 30, 4]


@pytest.mark.parametrize("spacing", ["0", "-1", "x", "nan", "inf", ""])
def test_a_spacing_that_is_no_distance_is_refused(spacing):
    with pytest.raises(SimSettingsError, match=f"copy_spacing:={spacing} is not a distance above"):
        read_grid(4, spacing, "")


@pytest.mark.parametrize("pose", ["3", "[1, 2]", "[1, 2, 3, 4, 5, nan]"])
def test_a_pose_that_is_none_is_refused(pose):
    with pytest.raises(SimSettingsError, match=r"^pose "):
        read_grid(4, "1.0", pose)


def test_a_namespace_that_cannot_be_numbered_is_refused(setup):
    with pytest.raises(SimSettingsError, match="namespace:=a/b does not name copies"):
        copies_of(setup, Grid(2, 1.0), namespace="a/b")
