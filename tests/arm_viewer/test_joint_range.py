"""Between which positions sliders move joints."""

import math

import pytest

from arm_description.urdf import parse_urdf
from arm_viewer.joint_range import JointRange, joint_ranges

ROBOT = """<robot name='r'><link name='base'/><link name='a'/><link name='b'/><link name='c'/>
  <link name='d'/><link name='e'/><link name='f'/>
  <joint name='turn' type='revolute'><parent link='base'/><child link='a'/>
    <limit lower='0.2' upper='2.0' effort='1' velocity='1'/></joint>
  <joint name='wheel' type='continuous'><parent link='base'/><child link='b'/></joint>
  <joint name='push' type='prismatic'><parent link='base'/><child link='c'/>
    <limit lower='0' upper='0.05' effort='1' velocity='1'/></joint>
  <joint name='finger' type='prismatic'><parent link='base'/><child link='d'/>
    <limit lower='0' upper='0.05' effort='1' velocity='1'/><mimic joint='push'/></joint>
  <joint name='stuck' type='revolute'><parent link='base'/><child link='e'/>
    <limit lower='0' upper='0' effort='1' velocity='1'/></joint>
  <joint name='free' type='floating'><parent link='base'/><child link='f'/></joint>
</robot>"""


def test_only_joints_with_a_position_of_their_own_and_room_have_one():
    turn, wheel, push = joint_ranges(parse_urdf(ROBOT).joints)
    assert (turn.name, turn.lower, turn.upper) == ("turn", 0.2, 2.0)
    assert (wheel.name, wheel.lower, wheel.upper) == ("wheel", -math.pi, math.pi)
    assert (push.name, push.lower, push.upper) == ("push", 0.0, 0.05)


def test_soft_limits_narrow_the_range_as_joint_state_publisher_gui_has_it():
    (joint,) = joint_ranges(
        parse_urdf("""<robot name='r'><link name='base'/><link name='a'/>
          <joint name='j' type='revolute'><parent link='base'/><child link='a'/>
            <limit lower='-1' upper='1' effort='1' velocity='1'/>
            <safety_controller k_velocity='1' soft_lower_limit='0.5' soft_upper_limit='9'/>
          </joint></robot>""").joints
    )
    assert (joint.lower, joint.upper, joint.centre) == (0.5, 1.0, 0.75)


@pytest.mark.parametrize(
    ("lower", "upper", "centre"), [(-1.0, 3.0, 0.0), (0.0, 1.0, 0.0), (0.2, 2.0, 1.1), (-3, -1, -2)]
)
def test_the_centre_is_zero_where_the_joint_can_be_there(lower, upper, centre):
    assert JointRange("j", lower, upper).centre == pytest.approx(centre)


def test_steps_are_powers_of_ten_and_positions_whole_steps_within_the_limits():
    joint = JointRange("j", -2.57, 2.57)
    assert joint.step == pytest.approx(0.001)
    assert joint.nearest(0.12345) == pytest.approx(0.123)
    assert joint.nearest(9.0) == 2.57
    assert math.copysign(1.0, joint.nearest(-1e-9)) == 1.0
    assert JointRange("j", 0.0, 0.05).step == pytest.approx(0.00001)
