"""mycobot.gazebo.launch.py: what its arguments come to, without starting anything."""

import os
from typing import Any

import pytest
import yaml

from launch_py.errors import UsageError
from launch_py.launch_description import expand_description
from launch_py.launch_description_sources import read_launch_file
from launch_py.plan.steps import GeneratedFile, LaunchPlan, ProcessStep
from launch_py.system.packages import Packages


def plan(**arguments: str) -> LaunchPlan:
    file = Packages(os.environ).launch_file("mycobot_gazebo", "mycobot.gazebo.launch.py")
    return expand_description(read_launch_file(file), arguments, dict(os.environ), file)


def processes(**arguments: str) -> dict[str, ProcessStep]:
    steps = [step for step in plan(**arguments).steps if isinstance(step, ProcessStep)]
    return {step.name: step for step in steps}


def parameters(**arguments: str) -> dict[str, Any]:
    """Return the parameters that the simulation's process gets, by node."""
    return parameters_of(processes(**arguments)["arm_gazebo_node"])


def parameters_of(process: ProcessStep) -> dict[str, Any]:
    files = [yaml.safe_load(w.text) for w in process.command if isinstance(w, GeneratedFile)]
    return {node: entry["ros__parameters"] for file in files for node, entry in file.items()}


def test_names_of_joints_are_the_robots():
    nodes = parameters(prefix="left_")

    assert nodes["/gripper_action_controller"]["joint"] == "left_gripper_controller"
    joints = nodes["/arm_controller"]["joints"]
    assert joints[0] == "left_link1_to_left_link2"
    assert joints[-1] == "left_link6_to_left_link6_flange"
    assert all(f'name="{joint}"' in nodes["/arm_gazebo"]["robot_description"] for joint in joints)


@pytest.mark.parametrize(
    ("arguments", "spawned"),
    [
        ({}, "joint_state_broadcaster,arm_controller,gripper_action_controller"),
        ({"use_gripper": "false"}, "joint_state_broadcaster,arm_controller"),
        ({"load_controllers": "false"}, ""),
    ],
)
def test_the_controllers_that_start(arguments, spawned):
    assert parameters(**arguments)["/arm_gazebo"]["spawn"] == spawned


def test_the_base_stands_on_the_floor_unless_a_place_is_given():
    assert parameters()["/arm_gazebo"]["pose"] == [0.0, 0.0, 0.025, 0.0, 0.0, 0.0]
    placed = parameters(x="0.1", z="0.05", yaw="1.5")["/arm_gazebo"]["pose"]
    assert placed == [0.1, 0.0, 0.05, 0.0, 0.0, 1.5]


def test_copies_have_controllers_of_their_own_joints():
    nodes = parameters(copies="2")
    gripper = nodes["/mycobot_280_1/gripper_action_controller"]
    assert gripper["joint"] == "mycobot_280_1_gripper_controller"
    titles = [panel.title for panel in plan(copies="2").panels]
    assert titles == ["2 robots are up, from /mycobot_280_0 to /mycobot_280_1"]


def test_the_state_publisher_can_be_left_out():
    assert set(processes()) == {"arm_gazebo_node", "robot_state_publisher"}
    assert set(processes(use_robot_state_pub="false")) == {"arm_gazebo_node"}


def test_worlds_may_be_named_as_gazebos_files_are():
    assert parameters(world_file="objects.world")["/arm_gazebo"]["world"] == "objects"


def test_sliders_beside_a_broadcaster_are_refused_with_the_way_out():
    with pytest.raises(UsageError, match="add load_controllers:=false"):
        plan(jsp_gui="true")


def test_the_simulation_s_own_choices_are_passed_on():
    chosen = parameters(real_time_factor="3", headless="true")["/arm_gazebo"]
    assert chosen["real_time_factor"] == 3
    shown = processes(viewer="true", viewer_port="8090")
    assert {"arm_viewer_node"} == set(shown) - set(processes())
    page = parameters_of(shown["arm_viewer_node"])["/**"]
    assert (page["port"], page["host"], page["read_only"]) == (8090, "127.0.0.1", False)


@pytest.mark.parametrize("given", [{}, {"prefix": "left_"}])
def test_the_pick_goes_by_the_simulation_s_clock_and_the_robot_s_names(given):
    file = Packages(os.environ).launch_file("mycobot_gazebo", "pick_and_place.launch.py")
    description = read_launch_file(file)
    steps = expand_description(description, given, dict(os.environ), file).steps
    [node] = [s for s in steps if isinstance(s, ProcessStep) and s.name == "mycobot_pick_and_place"]
    [written] = parameters_of(node).values()
    prefix = given.get("prefix", "")
    assert written == {"use_sim_time": True, "prefix": prefix, "hold_time": 5.0}
