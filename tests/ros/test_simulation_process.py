"""A start that fails midway stops what it has started."""

import subprocess
import sys
from pathlib import Path

import pytest
import yaml

from arm_description.resources import resolve_uri
from arm_description.xacro.expansion import expand_xacro

PROGRAM = """
import sys, threading
from unittest import mock

import psutil

from arm_control.errors import ArmControlError
from arm_gazebo import arm_gazebo_node

with mock.patch(sys.argv.pop(1), side_effect=ArmControlError("not today")):
    code = arm_gazebo_node.main()
threads = [thread.name for thread in threading.enumerate() if thread is not threading.main_thread()]
print(code, threads, psutil.Process().children())
"""


@pytest.fixture(scope="module")
def parameters(tmp_path_factory) -> Path:
    """A file that makes the simulation of the arm with its front camera."""
    arm = resolve_uri("package://arm_description/urdf/arm.urdf.xacro")
    path = tmp_path_factory.mktemp("simulation") / "parameters.yaml"
    settings = {"robot_description": expand_xacro(str(arm), {})}
    path.write_text(yaml.safe_dump({"arm_gazebo": {"ros__parameters": settings}}))
    return path


@pytest.mark.parametrize(
    "broken",
    [
        "arm_gazebo.physics.physics.Physics.__init__",
        "arm_control.manager.ros.controller_manager_server.ControllerManagerServer.__init__",
        "arm_gazebo.camera.feed.CameraFeed.start",
    ],
)
def test_a_failed_start_ends_the_loop_and_the_cameras(parameters, broken):
    run = subprocess.run(
        [
            *(sys.executable, "-c", PROGRAM, broken),
            *("--ros-args", "--params-file", str(parameters)),
        ],
        capture_output=True,
        text=True,
        timeout=90,
    )
    assert "not today" in run.stderr
    assert "Traceback" not in run.stderr
    assert run.stdout.splitlines()[-1] == "1 [] []"
    assert run.returncode == 0


def test_a_robot_without_hardware_is_refused_with_the_reason(tmp_path):
    path = tmp_path / "parameters.yaml"
    settings = {"robot_description": "<robot name='bare'><link name='base'/></robot>"}
    path.write_text(yaml.safe_dump({"arm_gazebo": {"ros__parameters": settings}}))
    run = subprocess.run(
        [
            *(sys.executable, "-m", "arm_gazebo.arm_gazebo_node"),
            *("--ros-args", "--params-file", str(path)),
        ],
        capture_output=True,
        text=True,
        timeout=90,
    )
    assert run.returncode == 1
    assert "the robot description has no <ros2_control> block" in run.stderr
    assert "Traceback" not in run.stderr
