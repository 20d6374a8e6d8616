"""Names of nodes made of names that ROS does not know the rules of."""

import pytest

from arm_control.ros.node_name import as_node_name


@pytest.mark.parametrize(
    ("text", "name"),
    [
        ("arm", "arm"),
        ("left-arm/joint 1", "left_arm_joint_1"),
        ("6dof_arm", "_6dof_arm"),
        ("ärmel", "_rmel"),
        ("", "_"),
    ],
)
def test_what_ros_does_not_allow_becomes_an_underscore(text: str, name: str):
    assert as_node_name(text) == name
