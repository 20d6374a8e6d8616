"""Conditions on launch configurations; the others are tested with the actions they switch."""

import pytest

from launch_py import DeclareLaunchArgument, LogInfo, SetLaunchConfiguration
from launch_py.conditions import LaunchConfigurationEquals, LaunchConfigurationNotEquals
from launch_py.substitutions import LaunchConfiguration


@pytest.mark.parametrize(
    ("name", "expected", "holds"),
    [
        ("world", "empty", True),
        ("world", ["em", LaunchConfiguration("end")], True),
        ("world", "Empty", False),
        ("world", "", False),
        ("world", None, False),
        ("rate", "1", True),
        ("rate", "1.0", False),
        ("missing", "empty", False),
        ("missing", "", False),
        ("missing", None, True),
    ],
)
def test_a_launch_configuration_is_compared_as_text(expand, name, expected, holds):
    plan = expand(
        [
            DeclareLaunchArgument("world", default_value="empty"),
            DeclareLaunchArgument("rate", default_value="1"),
            SetLaunchConfiguration("end", "pty"),
            LogInfo(msg="equal", condition=LaunchConfigurationEquals(name, expected)),
            LogInfo(
                msg="unequal",
                condition=LaunchConfigurationNotEquals(
                    launch_configuration_name=name, expected_value=expected
                ),
            ),
        ]
    )
    assert [step.text for step in plan.steps] == ["equal" if holds else "unequal"]
