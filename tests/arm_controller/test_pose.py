"""A pose that exists is complete and finite, and its limits come from the robot's description."""

import math
import os
from pathlib import Path

import pytest
from ament_index_python.packages import get_package_share_directory
from robots import joint, link, robot

from arm_controller.pose import (
    Limits,
    PoseError,
    PoseFileError,
    check_limits,
    read_limits,
    read_pose,
    read_pose_file,
    shown,
)
from arm_description import expand_xacro, resolve_uri

JOINTS = ("j0", "j1", "j2", "j3")


def test_integers_are_as_good_as_floats():
    assert read_pose([1, 0, 0.5, -2], JOINTS) == (1.0, 0.0, 0.5, -2.0)


def test_shows_six_decimals():
    assert shown((0.4, -0.1, 0.5, 0.4)) == "[0.400000, -0.100000, 0.500000, 0.400000]"


@pytest.mark.parametrize(
    ("values", "message"),
    [
        ([], "joints j0, j1, j2, j3; 0 were given"),
        ([0.0] * 5, "joints j0, j1, j2, j3; 5 were given"),
        *(
            ([0.0, 0.0, value, 0.0], "joint 'j2' cannot go to")
            for value in (math.nan, math.inf, -math.inf)
        ),
    ],
)
def test_refuses_what_is_no_pose(values, message):
    with pytest.raises(PoseError, match=message):
        read_pose(values, JOINTS)


ROBOT = robot(
    *map(link, ("base", "a", "b", "c", "d")),
    joint("turn", "base", "a", limits=(-2.57, 2.0), velocity=0.1),
    joint("slide", "a", "b", kind="prismatic", limits=(0.0, 0.3), velocity=0.5),
    joint("wheel", "b", "c", kind="continuous", limits=None),
    joint("glue", "c", "d", kind="fixed", limits=None),
)
NAMES = ("slide", "turn", "wheel")


@pytest.fixture
def limits() -> Limits:
    return read_limits(ROBOT, NAMES)


def test_a_pose_on_the_limits_is_allowed_and_one_just_beyond_is_not(limits):
    check_limits((0.3, -2.57, 1000.0), NAMES, limits)
    check_limits((1e9, -1e9), ("a", "b"), {})  # Of an unknown robot.
    with pytest.raises(PoseError) as caught:
        check_limits((0.301, -2.57, 1000.0), NAMES, limits)
    assert str(caught.value) == "joint 'slide' cannot go to 0.301: its limits are 0 to 0.3"


def test_an_unknown_joint_is_refused_with_those_that_exist():
    with pytest.raises(PoseError, match="no movable joint 'j9'; the robot has turn, slide, wheel"):
        read_limits(ROBOT, ["turn", "j9"])


def test_the_arm_of_the_suite_has_the_limits_of_its_description():
    description = expand_xacro(resolve_uri("package://arm_description/urdf/arm.urdf.xacro"))
    assert "<ros2_control" in description  # It names the joints a second time, without type.
    limits = read_limits(description, JOINTS)
    assert limits["j0"] == (-2.57, 2.57)
    with pytest.raises(PoseError, match="joint 'j0' cannot go to 9"):
        check_limits((9.0, 0.0, 0.0, 0.0), JOINTS, limits)


def test_a_robot_without_joints_has_none():
    with pytest.raises(PoseError, match="no movable joint 'j0'; the robot has none"):
        read_limits("<robot name='thing'><link name='thing'/></robot>", ["j0"])


def test_a_fixed_joint_is_refused():
    with pytest.raises(PoseError, match="no movable joint 'glue'"):
        read_limits(ROBOT, ["glue"])


@pytest.mark.parametrize("text", ["", "robot", ROBOT.replace("0.3", "far")])
def test_what_is_not_a_urdf_is_refused(text):
    with pytest.raises(PoseError, match="it is not a URDF"):
        read_limits(text, NAMES)


@pytest.fixture
def poses_in(tmp_path):
    def read(text: str):
        path = tmp_path / "poses.yaml"
        path.write_text(text)
        return read_pose_file(path, ("j0", "j1"))

    return read


def test_reads_poses_in_order(poses_in):
    assert poses_in("poses:\n  - [1, 0.5]\n  - [-1e-3, .25]\n") == [(1.0, 0.5), (-0.001, 0.25)]


@pytest.mark.parametrize(
    ("text", "message"),
    [
        ("", "must have the key 'poses'"),
        ("- [0, 0]\n", "must have the key 'poses'"),
        ("{}\n", "must have the key 'poses'"),
        ("poses:\n", "line 1: 'poses' must be a list"),
        ("poses: []\n", "line 1: 'poses' must be a list"),
        ("poses:\n  - [0, 0]\nspeed: 3\n", "line 3: unknown key 'speed'"),
        ("? [1]\n: 2\n", "line 1: unknown key"),
        ("poses:\n  - 5\n", "line 2: a pose is a list of 2 numbers"),
        ("poses:\n  - [0, 0]\n  - [0]\n", "line 3: a pose is 2 numbers.*1 were given"),
        ("poses:\n  - [0, up]\n", "line 2: a pose is made of numbers; .*'up'"),
        ("poses:\n  - [0, true]\n", "line 2: a pose is made of numbers; .*'true'"),
        ("poses:\n  - [0, [1]]\n", "line 2: a pose is made of numbers"),
        ("poses:\n  - [0, nan]\n", "line 2: joint 'j1' cannot go to nan"),
        ("poses: [\n", "is not YAML: .* line 2"),
        ("poses: \x00\n", "is not YAML"),
        ("poses: " + 5000 * "[", "is not YAML"),
    ],
)
def test_names_the_file_and_what_is_wrong(poses_in, text, message):
    with pytest.raises(PoseFileError, match=message) as caught:
        poses_in(text)
    assert "poses.yaml" in str(caught.value)


def test_names_a_missing_file():
    with pytest.raises(PoseFileError, match=r"the pose file /nowhere/poses\.yaml does not exist"):
        read_pose_file(Path("/nowhere/poses.yaml"), JOINTS)


def test_a_fifo_is_refused_at_once(tmp_path):
    os.mkfifo(tmp_path / "pipe")
    with pytest.raises(PoseFileError, match="is not a regular file"):
        read_pose_file(tmp_path / "pipe", JOINTS)


def test_a_file_that_is_not_text_is_refused(tmp_path):
    (tmp_path / "poses.yaml").write_bytes(b"\xff\xfe\x00")
    with pytest.raises(PoseFileError, match=f"cannot read the pose file {tmp_path}"):
        read_pose_file(tmp_path / "poses.yaml", JOINTS)


def test_the_defined_poses_are_the_five_of_the_original():
    file = Path(get_package_share_directory("arm_controller")) / "config/poses.yaml"
    assert read_pose_file(file, JOINTS) == [
        (0.5, 0.5, 0.5, 0.5),
        (0.7, 1.4, 0.5, 0.5),
        (0.5, 1.0, 0.6, 0.6),
        (0.3, 0.6, 0.3, 0.3),
        (0.0, 0.0, 0.0, 0.0),
    ]
