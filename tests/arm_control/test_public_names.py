"""The public names of arm_control."""

import subprocess
import sys

import pytest

import arm_control


def test_every_public_name_exists():
    assert sorted(arm_control.__all__) == arm_control.__all__
    assert all(hasattr(arm_control, name) for name in arm_control.__all__)
    assert set(arm_control.__all__) <= set(dir(arm_control))


def test_a_wrong_name_is_an_attribute_error():
    with pytest.raises(AttributeError, match="no attribute 'Contoller'"):
        _ = arm_control.Contoller


def test_what_starts_often_imports_little():
    code = (
        "import sys, arm_control.spawner.spawner_node, arm_control.spawner.unspawner_node, "
        "arm_control.spawner.hardware_spawner_node; "
        "sys.exit(bool({'numpy', 'lxml', 'arm_description', 'rclpy', 'yaml'} & set(sys.modules)))"
    )
    assert subprocess.run([sys.executable, "-c", code], check=False).returncode == 0


def test_the_core_needs_neither_ros_nor_mujoco():
    code = (
        "import sys, arm_control, arm_control.testing; "
        "import arm_control.controllers.forward_command.controller; "
        "import arm_control.controllers.joint_state_broadcaster.controller; "
        "import arm_control.manager.registry, arm_control.spawner.command_line; "
        "sys.exit(bool({'rclpy', 'mujoco'} & set(sys.modules)))"
    )
    assert subprocess.run([sys.executable, "-c", code], check=False).returncode == 0
