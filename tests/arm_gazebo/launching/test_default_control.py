"""Default hardware and controllers for a robot without any."""

import pytest

from arm_control.hardware.info import parse_hardware_info
from arm_description.urdf.parser import parse_urdf
from arm_gazebo.launching.default_control import (
    HardwareJoints,
    commandable_joints,
    default_parameters,
    hardware_joints,
    has_hardware,
    with_hardware,
)

LIMIT = '<limit lower="-1" upper="1" effort="1" velocity="1"/>'


def joint(name, kind, child, more=LIMIT):
    return (
        f'<joint name="{name}" type="{kind}"><parent link="base"/><child link="{child}"/>'
        f"{more}</joint>\n"
    )


URDF = (
    '<robot name="r">\n'
    + "".join(f'<link name="{name}"/>' for name in ("base", "a", "b", "c", "d", "e"))
    + joint("turn", "revolute", "a")
    + joint("spin", "continuous", "b", "")
    + joint("slide & co", "prismatic", "c").replace("&", "&amp;")
    + joint("finger", "revolute", "d", LIMIT + '<mimic joint="turn"/>')
    + joint("glue", "fixed", "e", "")
    + "</robot>"
)


def test_every_independent_joint_is_commanded():
    robot = parse_urdf(URDF)
    assert commandable_joints(robot) == ("turn", "spin", "slide & co")
    [component] = parse_hardware_info(with_hardware(URDF, robot))
    assert [j.name for j in component.joints if j.command_interfaces] == list(
        commandable_joints(robot)
    )


def test_a_mimicking_joint_shows_its_states():
    [component] = parse_hardware_info(with_hardware(URDF, parse_urdf(URDF)))
    finger = next(joint for joint in component.joints if joint.name == "finger")
    assert [state.name for state in finger.state_interfaces] == ["position", "velocity", "effort"]


def test_lines_keep_their_numbers():
    robot = parse_urdf(URDF)
    again = parse_urdf(with_hardware(URDF, robot))
    assert [joint.line for joint in again.joints] == [joint.line for joint in robot.joints]


@pytest.mark.parametrize(
    ("text", "has"),
    [
        (URDF, False),
        (URDF.replace("</robot>", "<!-- <ros2_control/>\n --></robot>"), False),
        (URDF.replace("</robot>", '<ros2_control name="x"/></robot>'), True),
        (URDF.replace("</robot>", '<!-- a --><ros2_control name="x"/><!-- b --></robot>'), True),
    ],
)
def test_a_ros2_control_block_in_a_comment_does_not_count(text, has):
    assert has_hardware(text) is has


def test_parameters_have_the_form_of_a_file():
    content = default_parameters(HardwareJoints(("turn", "spin"), ("turn", "spin")))
    assert content["position_controller"] == {"ros__parameters": {"joints": ["turn", "spin"]}}
    manager = content["controller_manager"]["ros__parameters"]
    assert manager["position_controller"] == {
        "type": "position_controllers/JointGroupPositionController"
    }


@pytest.mark.parametrize(
    ("joints", "names"),
    [
        (HardwareJoints(), []),
        (HardwareJoints(observed=("turn",)), ["joint_state_broadcaster"]),
        (
            HardwareJoints(position_commanded=("turn",)),
            ["position_controller", "joint_trajectory_controller"],
        ),
    ],
)
def test_a_controller_without_joints_is_not_made_up(joints, names):
    content = default_parameters(joints)
    assert list(content["controller_manager"]["ros__parameters"]) == ["update_rate", *names]
    assert ("position_controller" in content) is ("position_controller" in names)


def test_joints_are_parted_by_what_the_hardware_does_with_them():
    block = (
        '<ros2_control name="own" type="system"><hardware><plugin>a/B</plugin></hardware>'
        '<joint name="turn"><command_interface name="position"/></joint>'
        '<joint name="spin"><command_interface name="velocity"/>'
        '<state_interface name="velocity"/></joint>'
        '<joint name="finger"><command_interface name="position"/>'
        '<state_interface name="position"/></joint>'
        '<joint name="glue"><state_interface name="position"/></joint></ros2_control>'
    )
    hardware = parse_hardware_info(URDF.replace("</robot>", f"{block}</robot>"))
    assert hardware_joints(parse_urdf(URDF), hardware) == HardwareJoints(
        observed=("spin", "finger"), position_commanded=("turn",), otherwise_commanded=("spin",)
    )


def test_a_joint_with_mimic_false_is_driven_independently():
    robot = parse_urdf(URDF)
    block = (
        '<ros2_control name="s" type="system"><hardware><plugin>a/B</plugin></hardware>'
        '<joint name="finger"{}><command_interface name="position"/></joint></ros2_control></robot>'
    )

    def positioned(attribute):
        text = URDF.replace("</robot>", block.format(attribute))
        return hardware_joints(robot, parse_hardware_info(text)).position_commanded

    assert positioned("") == ()
    assert positioned(' mimic="false"') == ("finger",)
