"""A pose that exists is complete and finite, and its limits come from the robot's description."""

import math

import pytest

from arm_controller.pose import (
    AllowedRange,
    Limits,
    PoseError,
    check_limits,
    read_limits,
    read_pose,
    shortest_move,
    shown,
)
from arm_description.errors import UrdfError

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
        *(([0.0, 0.0, value, 0.0], "is not one") for value in ("0.5", None, True, [0.5])),
        ([10**400, 0, 0, 0], "too large"),
    ],
)
def test_refuses_what_is_no_pose(values, message):
    with pytest.raises(PoseError, match=message):
        read_pose(values, JOINTS)


ROBOT = """
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
NAMES = ("slide", "turn", "wheel")


@pytest.fixture
def limits() -> Limits:
    return read_limits(ROBOT, NAMES)


def test_a_pose_on_the_limits_is_allowed_and_one_just_beyond_is_not(limits):
    check_limits((0.3, -2.57, 1000.0), limits)
    check_limits((1e9, -1e9), (AllowedRange("a"), AllowedRange("b")))  # Of an unknown robot.
    with pytest.raises(PoseError) as caught:
        check_limits((0.301, -2.57, 1000.0), limits)
    assert str(caught.value) == "joint 'slide' cannot go to 0.301 m: its limits are 0 to 0.3 m"


def test_the_slowest_joint_sets_the_time_of_a_move(limits):
    start = {"turn": 1.0, "slide": 0.0, "wheel": 0.0}
    joint, time_s = shortest_move((0.3, -1.0, 50.0), start, limits)
    assert (joint.name, time_s) == ("turn", pytest.approx(20.0))
    # A joint of unknown position counts as not moving.
    assert shortest_move((0.3, 1.0, 0.0), {}, limits)[1] == 0.0


def test_an_unknown_joint_is_refused_with_those_that_exist():
    with pytest.raises(UrdfError, match="no joint 'j9'; the robot has turn, slide"):
        read_limits(ROBOT, ["turn", "j9"])


def test_a_fixed_joint_is_refused():
    with pytest.raises(PoseError, match="joint 'glue' is fixed"):
        read_limits(ROBOT, ["glue"])
