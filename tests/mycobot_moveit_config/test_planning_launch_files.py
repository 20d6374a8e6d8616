"""move_group.launch.py and demo.launch.py: what they start."""

import os

import yaml

from launch_py.launch_description import expand_description
from launch_py.launch_description_sources import read_launch_file
from launch_py.plan.steps import GeneratedFile, ProcessStep
from launch_py.system.packages import Packages


def processes(name: str, **arguments: str) -> dict[str, ProcessStep]:
    file = Packages(os.environ).launch_file("mycobot_moveit_config", name)
    plan = expand_description(read_launch_file(file), arguments, dict(os.environ), file)
    return {step.name: step for step in plan.steps if isinstance(step, ProcessStep)}


def parameters(process: ProcessStep) -> dict:
    files = [yaml.safe_load(w.text) for w in process.command if isinstance(w, GeneratedFile)]
    return {k: v for file in files for e in file.values() for k, v in e["ros__parameters"].items()}


def test_move_group_gets_the_configuration():
    started = processes("move_group.launch.py", use_rviz="false")
    assert set(started) == {"move_group"}
    given = parameters(started["move_group"])
    assert 'group_state name="ready"' in given["robot_description_semantic"]
    assert {"arm", "gripper"} <= set(given["robot_description_kinematics"])
    assert given["robot_description_planning"]["cartesian_limits"]["max_trans_vel"] == 1.0
    controllers = given["moveit_simple_controller_manager"]["controller_names"]
    assert controllers == ["arm_controller", "gripper_action_controller"]


def test_the_demo_has_mock_hardware_instead_of_a_simulation():
    started = processes("demo.launch.py", viewer="false")
    assert {"robot_state_publisher", "ros2_control_node", "spawner", "move_group"} <= set(started)
    assert "arm_gazebo_node" not in started
    assert "mock_components" in parameters(started["robot_state_publisher"])["robot_description"]
