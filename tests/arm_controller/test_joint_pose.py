"""A pose that exists is complete and finite, and its limits come from the robot's description."""

import math

import pytest

from arm_controller.errors import PoseError
from arm_controller.joint_pose import JointPose, limits_of, no_limits
from arm_description.errors import UrdfError
from arm_description.urdf.parser import parse_urdf

JOINTS = ("j0", "j1", "j2", "j3")


def test_integers_are_as_good_as_floats():
    assert JointPose.of(JOINTS, [1, 0, 0.5, -2]).positions == (1.0, 0.0, 0.5, -2.0)


def test_shows_six_decimals():
    assert (
        str(JointPose.of(JOINTS, [0.4, -0.1, 0.5, 0.4]))
        == "[0.400000, -0.100000, 0.500000, 0.400000]"
    )


@pytest.mark.parametrize("values", [[], [1.0, 2.0, 3.0], [0.0] * 5])
def test_refuses_a_wrong_length_and_names_the_joints(values):
    with pytest.raises(PoseError, match=f"joints j0, j1, j2, j3; {len(values)} were given"):
        JointPose.of(JOINTS, values)


@pytest.mark.parametrize("value", [math.nan, math.inf, -math.inf])
def test_refuses_what_is_not_finite_and_names_the_joint(value):
    with pytest.raises(PoseError, match="joint 'j2' cannot go to"):
        JointPose.of(JOINTS, [0.0, 0.0, value, 0.0])


@pytest.mark.parametrize("value", ["0.5", None, True, [0.5]])
def test_refuses_a_value_that_is_not_a_number(value):
    with pytest.raises(PoseError, match="is not one"):
        JointPose.of(JOINTS, [0.0, 0.0, value, 0.0])


def test_refuses_an_integer_beyond_any_float():
    with pytest.raises(PoseError, match="too large"):
        JointPose.of(JOINTS, [10**400, 0, 0, 0])


ROBOT = parse_urdf(
    """
<robot name="small">
  <link name="base"/> <link name="a"/> <link name="b"/> <link name="c"/> <link name="d"/>
  <joint name="turn" type="revolute">
    <parent link="base"/> <child link="a"/>
    <limit lower="-2.57" upper="2" effort="5" velocity="0.1"/>
  </joint>
  <joint name="slide" type="prismatic">
    <parent link="a"/> <child link="b"/>
    <limit lower="0" upper="0.3" effort="5" velocity="0.5"/>
  </joint>
  <joint name="wheel" type="continuous"> <parent link="b"/> <child link="c"/> </joint>
  <joint name="glue" type="fixed"> <parent link="c"/> <child link="d"/> </joint>
</robot>
"""
)
NAMES = ("slide", "turn", "wheel")


def pose(*positions: float) -> JointPose:
    return JointPose(NAMES, positions)


def test_a_pose_on_the_limits_is_allowed_and_one_just_beyond_is_not():
    limits = limits_of(ROBOT, NAMES)
    limits.check(pose(0.3, -2.57, 1000.0))
    with pytest.raises(PoseError, match=r"'slide' cannot go to 0\.301 m"):
        limits.check(pose(0.301, -2.57, 1000.0))


def test_a_position_beyond_a_limit_is_refused_with_joint_and_limits():
    with pytest.raises(PoseError) as caught:
        limits_of(ROBOT, NAMES).check(pose(0.0, -5.0, 0.0))
    assert str(caught.value) == ("joint 'turn' cannot go to -5 rad: its limits are -2.57 to 2 rad")


def test_a_prismatic_joint_is_measured_in_metres():
    with pytest.raises(PoseError, match=r"joint 'slide' cannot go to 0.31 m"):
        limits_of(ROBOT, NAMES).check(pose(0.31, 0.0, 0.0))


def test_the_slowest_joint_sets_the_time_of_a_move():
    limits = limits_of(ROBOT, NAMES)
    start = {"turn": 1.0, "slide": 0.0, "wheel": 0.0}
    name, time_s = limits.shortest_move_s(start, pose(0.3, -1.0, 50.0))
    assert (name, time_s) == ("turn", pytest.approx(20.0))


def test_a_joint_of_unknown_position_counts_as_not_moving():
    assert limits_of(ROBOT, NAMES).shortest_move_s({}, pose(0.3, 1.0, 0.0))[1] == 0.0


def test_an_unknown_joint_is_refused_with_those_that_exist():
    with pytest.raises(UrdfError, match="no joint 'j9'; the robot has turn, slide"):
        limits_of(ROBOT, ["turn", "j9"])


def test_a_fixed_joint_is_refused():
    with pytest.raises(PoseError, match="joint 'glue' is fixed"):
        limits_of(ROBOT, ["glue"])


def test_an_unknown_robot_allows_everything():
    limits = no_limits(NAMES)
    limits.check(pose(1e9, -1e9, 0.0))
    assert limits.range_of("turn").velocity == math.inf
