"""Where the limits of joints come from."""

import math

import pytest

from arm_control.errors import HardwareInfoError
from arm_control.hardware.joint_limits import JointLimits, SoftLimits, read_joint_limits


def robot(joint: str, interfaces: str = "<command_interface name='position'/>") -> str:
    return (
        "<robot name='r'><link name='a'/><link name='b'/>"
        f"<joint name='j' {joint}<parent link='a'/><child link='b'/></joint>"
        "<ros2_control name='H' type='system'><hardware><plugin>x</plugin></hardware>"
        f"<joint name='j'>{interfaces}</joint></ros2_control></robot>"
    )


REVOLUTE = "type='revolute'><limit lower='-1' upper='2' velocity='3' effort='4'/>"


def limits(joint: str = REVOLUTE, interfaces: str = "<command_interface name='position'/>"):
    return read_joint_limits(robot(joint, interfaces))["j"]


def interface(name: str, inner: str) -> str:
    return f"<command_interface name='{name}'>{inner}</command_interface>"


def bounds(minimum: float, maximum: float) -> str:
    return f"<param name='min'>{minimum}</param><param name='max'>{maximum}</param>"


def test_the_limit_element_gives_position_velocity_and_effort():
    assert limits() == JointLimits(-1.0, 2.0, 3.0, 4.0)


def test_a_continuous_joint_has_no_position_limits():
    found = limits("type='continuous'><limit velocity='3' effort='4'/>")
    assert found == JointLimits(velocity=3.0, effort=4.0)


def test_zero_speed_and_effort_count_as_not_given():
    found = limits("type='revolute'><limit lower='-1' upper='2' velocity='0' effort='0'/>")
    assert (found.velocity, found.effort) == (math.inf, math.inf)


def test_a_safety_controller_gives_soft_limits():
    safety = "<safety_controller soft_lower_limit='-0.5' soft_upper_limit='1' k_position='20'"
    found = limits(f"{REVOLUTE}{safety} k_velocity='10'/>")
    assert found.soft == SoftLimits(-0.5, 1.0, 20.0, 10.0)


@pytest.mark.parametrize(
    ("name", "low", "high", "expected"),
    [
        ("position", -0.5, 9.0, JointLimits(-0.5, 2.0, 3.0, 4.0)),
        ("velocity", -1.0, 2.0, JointLimits(-1.0, 2.0, 1.0, 4.0)),
        ("velocity", -9.0, 9.0, JointLimits(-1.0, 2.0, 3.0, 4.0)),
        ("effort", -2.0, 3.0, JointLimits(-1.0, 2.0, 3.0, 2.0)),
        ("acceleration", -5.0, 6.0, JointLimits(-1.0, 2.0, 3.0, 4.0, 5.0)),
        ("jerk", -7.0, 7.0, JointLimits(-1.0, 2.0, 3.0, 4.0, jerk=7.0)),
        ("temperature", 0.0, 1.0, JointLimits(-1.0, 2.0, 3.0, 4.0)),
    ],
)
def test_a_command_interface_narrows_its_own_quantity(name, low, high, expected):
    assert limits(interfaces=interface(name, bounds(low, high))) == expected


def test_limits_can_be_switched_off_for_a_joint():
    inner = "<limits enable='false'/><command_interface name='position'/>"
    assert limits(interfaces=inner) == JointLimits()
    assert limits(interfaces=inner.replace("false", "true")) == JointLimits(-1.0, 2.0, 3.0, 4.0)


def test_limits_can_be_switched_off_for_one_interface():
    off = "<limits enable='false'/>"
    found = limits(interfaces=interface("position", "") + interface("velocity", off))
    assert found == JointLimits(-1.0, 2.0, math.inf, 4.0)
    found = limits(interfaces=interface("position", off))
    assert found == JointLimits(velocity=3.0, effort=4.0)


def test_a_joint_that_the_urdf_does_not_have_is_limited_by_its_interfaces_alone():
    text = robot(REVOLUTE, interface("position", bounds(-2.0, 3.0))).replace(
        "<joint name='j' type", "<joint name='other' type"
    )
    assert read_joint_limits(text)["j"] == JointLimits(-2.0, 3.0)


def test_limits_that_leave_no_position_are_refused():
    with pytest.raises(HardwareInfoError, match="joint 'j' has no allowed position"):
        limits(interfaces=interface("position", bounds(3.0, 4.0)))


def test_a_description_that_cannot_be_read_says_so():
    with pytest.raises(HardwareInfoError, match="no joint limits can be read: "):
        read_joint_limits("<robot name='r'><link name='a'/><link name='b'/></robot>")
