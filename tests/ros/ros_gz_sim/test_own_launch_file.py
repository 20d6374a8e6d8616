"""A student's own package, its launch file typed as on the pages: Gazebo first, then the robot."""

from pathlib import Path

import pytest
from sensor_msgs.msg import JointState
from std_msgs.msg import Float64MultiArray

LAUNCH = """
import os

from ament_index_python.packages import get_package_share_directory
from launch import LaunchDescription
from launch.actions import (
    DeclareLaunchArgument, ExecuteProcess, IncludeLaunchDescription, RegisterEventHandler)
from launch.event_handlers import OnProcessExit
from launch.launch_description_sources import PythonLaunchDescriptionSource
from launch.substitutions import Command, FindExecutable, LaunchConfiguration
from launch_ros.actions import Node
from launch_ros.parameter_descriptions import ParameterValue


def generate_launch_description():
    folder = os.path.dirname(__file__)
    gz_sim = os.path.join(
        get_package_share_directory("ros_gz_sim"), "launch", "gz_sim.launch.py")
    robot_description = {"robot_description": ParameterValue(Command([
        FindExecutable(name="xacro"), " ", os.path.join(folder, "one.urdf.xacro"),
        " yaml:=", os.path.join(folder, "controllers.yaml"),
    ]), value_type=str)}
    create = Node(
        package="ros_gz_sim", executable="create", output="screen",
        arguments=["-topic", "robot_description", "-name", "one", "-allow_renaming", "true",
                   "-x", "0.1", "-z", "0.5"])
    broadcaster = Node(package="controller_manager", executable="spawner",
                       arguments=["joint_state_broadcaster", "-c", "/controller_manager"])
    position = ExecuteProcess(
        cmd=["ros2", "control", "load_controller", "--set-state", "active",
             "position_controller"], output="screen")
    return LaunchDescription([
        DeclareLaunchArgument("gz_args", default_value="-r -v 4 empty.sdf"),
        IncludeLaunchDescription(
            PythonLaunchDescriptionSource([gz_sim]),
            launch_arguments={"gz_args": LaunchConfiguration("gz_args"),
                              "on_exit_shutdown": "true"}.items()),
        Node(package="robot_state_publisher", executable="robot_state_publisher",
             parameters=[robot_description, {"use_sim_time": True}]),
        create,
        Node(package="ros_gz_bridge", executable="parameter_bridge",
             arguments=["/clock@rosgraph_msgs/msg/Clock[gz.msgs.Clock",
                        "/joint_states@sensor_msgs/msg/JointState@gz.msgs.Model",
                        "--ros-args", "-r", "/joint_states:=/renamed_states"]),
        RegisterEventHandler(OnProcessExit(target_action=create, on_exit=[broadcaster])),
        RegisterEventHandler(OnProcessExit(target_action=broadcaster, on_exit=[position])),
    ])
"""

XACRO = """<?xml version="1.0"?>
<robot name="one" xmlns:xacro="http://www.ros.org/wiki/xacro">
  <xacro:arg name="yaml" default=""/>
  <link name="world"/>
  <link name="base"/>
  <link name="tip"><inertial><mass value="1"/><inertia ixx="0.01" iyy="0.01" izz="0.01"
    ixy="0" ixz="0" iyz="0"/></inertial></link>
  <joint name="fixed" type="fixed"><parent link="world"/><child link="base"/></joint>
  <joint name="turn" type="revolute"><parent link="base"/><child link="tip"/><axis xyz="0 0 1"/>
    <limit lower="-2" upper="2" effort="10" velocity="2"/></joint>
  <ros2_control name="GazeboSimSystem" type="system">
    <hardware><plugin>gz_ros2_control/GazeboSimSystem</plugin></hardware>
    <joint name="turn"><command_interface name="position"/>
      <state_interface name="position"/><state_interface name="velocity"/></joint>
  </ros2_control>
  <gazebo><plugin filename="gz_ros2_control-system"
    name="gz_ros2_control::GazeboSimROS2ControlPlugin">
    <parameters>$(arg yaml)</parameters></plugin></gazebo>
</robot>
"""

CONTROLLERS = """
controller_manager:
  ros__parameters:
    update_rate: 100
    joint_state_broadcaster: {type: joint_state_broadcaster/JointStateBroadcaster}
    position_controller: {type: position_controllers/JointGroupPositionController}
position_controller:
  ros__parameters: {joints: [turn]}
"""


@pytest.fixture
def package(tmp_path) -> Path:
    (tmp_path / "one.urdf.xacro").write_text(XACRO)
    (tmp_path / "controllers.yaml").write_text(CONTROLLERS)
    (tmp_path / "one.launch.py").write_text(LAUNCH)
    return tmp_path / "one.launch.py"


def test_the_robot_that_it_spawns_moves(launch, client, package):
    started = launch(str(package))
    started.wait_for_line("the world waits for its robot")
    started.wait_for_line("Entity creation successful.")
    started.wait_for_line("Configured and activated joint_state_broadcaster")
    started.wait_for_line("Successfully loaded controller position_controller into state active")

    states = client.subscribe(JointState, "/renamed_states")
    commands = client.publisher(Float64MultiArray, "/position_controller/commands")
    commands.publish(Float64MultiArray(data=[0.5]))
    reached = states.wait_until(
        lambda messages: messages and abs(messages[-1].position[0] - 0.5) < 0.01,
        "the joint stands at 0.5 rad",
    )
    assert reached[-1].name == ["turn"]
    assert started.stop() == 0
