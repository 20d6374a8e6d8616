"""Launch files built like those that public arms ship; each says at its top what is to come of it.

`starts:` names the processes that start at once, `later:` those that an event starts, `managed:`
the nodes whose transitions are watched, `warns:` parts of the warnings, and `arguments:` what is
typed. Everything that a file says must come, and nothing else.
"""

import os
import re
from pathlib import Path

import pytest

from launch_py.launch_description import expand_description
from launch_py.launch_description_sources import read_launch_file
from launch_py.plan.steps import TriggerKind

FILES = sorted((Path(__file__).parent / "structures").iterdir())
XACRO = """<robot xmlns:xacro="http://www.ros.org/wiki/xacro" name="arm">
  <xacro:arg name="name" default="arm"/><link name="$(arg name)"/>
</robot>
"""
SIMULATOR = """
from launch import LaunchDescription
from launch.actions import DeclareLaunchArgument, ExecuteProcess
from launch.substitutions import LaunchConfiguration


def generate_launch_description():
    return LaunchDescription([
        DeclareLaunchArgument("gz_args", default_value=""),
        ExecuteProcess(
            cmd=[["echo ", LaunchConfiguration("gz_args")]], shell=True, name="gzserver"
        ),
    ])
"""
GRIPPER = """
from launch import LaunchDescription
from launch.actions import DeclareLaunchArgument
from launch.substitutions import LaunchConfiguration
from launch_ros.actions import Node


def generate_launch_description():
    return LaunchDescription([
        DeclareLaunchArgument("joint"),
        DeclareLaunchArgument("namespace", default_value=""),
        Node(package="demo_arm", executable="gripper", namespace=LaunchConfiguration("namespace"),
             parameters=[{"joint": LaunchConfiguration("joint")}]),
    ])
"""


@pytest.fixture
def demo_arm(package_prefix):
    """A package with what the files refer to."""
    share = package_prefix("demo_arm", "driver", "dashboard", "detector", "servo", "gripper")
    (share / "urdf").mkdir()
    (share / "urdf" / "arm.urdf.xacro").write_text(XACRO)
    (share / "config").mkdir()
    (share / "config" / "arm.yaml").write_text("/**:\n  ros__parameters:\n    rate: 100\n")
    (share / "config" / "limits.yaml").write_text("max_velocity: 1.5\n")
    (share / "launch" / "simulator.launch.py").write_text(SIMULATOR)
    (share / "launch" / "gripper.launch.py").write_text(GRIPPER)
    return share


def promised(path: Path, key: str) -> list[str]:
    return re.findall(rf"{key}: (.*?)(?: -->)?$", path.read_text(), re.MULTILINE)


def words(path: Path, key: str) -> list[str]:
    return " ".join(promised(path, key)).split()


@pytest.mark.usefixtures("demo_arm")
@pytest.mark.parametrize("path", FILES, ids=[path.name for path in FILES])
def test_what_a_file_promises_comes_of_it(path):
    arguments = dict(word.split(":=") for word in words(path, "arguments"))
    plan = expand_description(read_launch_file(path), arguments, dict(os.environ), path)
    waiting = {
        step.name
        for step in plan.processes
        if step.delay_s or any(trigger.kind is TriggerKind.EXITED for trigger in step.after)
    }
    helpers = {step.name for step in plan.processes if "lifecycle_client" in str(step.command)}
    started = [s.name for s in plan.processes if s.name not in waiting | helpers]
    assert sorted(started) == sorted(words(path, "starts"))
    assert waiting == set(words(path, "later"))
    watched = [name.rpartition(" ")[2] for name in helpers if name.startswith("transitions")]
    assert watched == words(path, "managed")
    skipped = [text for text in plan.warnings if " is skipped" in text]
    expected = promised(path, "warns")
    assert len(skipped) == len(expected)
    for text in expected:
        assert any(text in warning for warning in skipped), text
    replaced = [text for text in plan.warnings if "runs in place of" in text]
    assert len(skipped) + len(replaced) == len(plan.warnings)


def test_there_are_enough_of_them():
    assert len(FILES) >= 20
