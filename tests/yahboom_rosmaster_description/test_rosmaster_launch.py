"""robot_state_publisher.launch.py: what its arguments come to, without starting anything."""

import os

import pytest
import yaml

from launch_py.launch_description import expand_description
from launch_py.launch_description_sources import read_launch_file
from launch_py.plan.steps import GeneratedFile, ProcessStep
from launch_py.system.packages import Packages

SLIDERS = "joint_state_publisher_gui"
FILE = ("yahboom_rosmaster_description", "robot_state_publisher.launch.py")


def processes(**arguments: str) -> dict[str, ProcessStep]:
    file = Packages(os.environ).launch_file(*FILE)
    plan = expand_description(read_launch_file(file), arguments, dict(os.environ), file)
    return {step.name: step for step in plan.steps if isinstance(step, ProcessStep)}


def parameters(process: ProcessStep) -> dict:
    (file,) = (word for word in process.command if isinstance(word, GeneratedFile))
    ((_, entry),) = yaml.safe_load(file.text).items()
    return entry["ros__parameters"]


def test_without_sliders_somebody_else_publishes_the_wheels():
    started = processes(jsp_gui="false", use_rviz="false")

    assert set(started) == {"robot_state_publisher", "joint_state_publisher"}


def test_the_page_has_the_sliders_by_itself():
    started = processes(use_rviz="false")

    assert set(started) == {"robot_state_publisher", "arm_viewer_node"}
    assert parameters(started["arm_viewer_node"])["publish_joint_states"] is True


def test_the_sliders_of_a_ros_2_installation_come_first(tmp_path, monkeypatch):
    marker = tmp_path / "share/ament_index/resource_index/packages" / SLIDERS
    program = tmp_path / "lib" / SLIDERS / SLIDERS
    for file in (marker, program):
        file.parent.mkdir(parents=True)
        file.touch(0o755)
    monkeypatch.setenv("AMENT_PREFIX_PATH", str(tmp_path), prepend=os.pathsep)

    started = processes(use_rviz="false")

    assert set(started) == {"robot_state_publisher", SLIDERS}


@pytest.mark.parametrize("prefix", ["", "left_"])
def test_rviz_looks_from_the_robot_s_own_base(prefix, tmp_path, monkeypatch):
    program = tmp_path / "rviz2"
    program.write_text("#!/bin/sh\n")
    program.chmod(0o755)
    monkeypatch.setenv("PATH", str(tmp_path), prepend=os.pathsep)

    command = processes(jsp_gui="false", prefix=prefix)["rviz2"].command

    assert command[command.index("-f") + 1] == f"{prefix}base_link"
    assert str(command[command.index("-d") + 1]).endswith("yahboom_rosmaster_description.rviz")


def test_the_arguments_reach_the_description_and_the_clock():
    started = processes(
        jsp_gui="false", use_rviz="false", prefix="a_", use_gazebo="true", use_sim_time="true"
    )

    for process in started.values():
        given = parameters(process)
        assert given["use_sim_time"] is True
        assert 'name="a_front_left_wheel_joint"' in given["robot_description"]
        assert "gz_ros2_control/GazeboSimSystem" in given["robot_description"]
