# MoveIt's move_group, which the suite's own replaces, with its static transform.
# starts: static_transform_publisher robot_state_publisher move_group ros2_control_node spawner
import os

import yaml
from ament_index_python.packages import get_package_share_directory
from launch_ros.actions import Node

from launch import LaunchDescription


def load_yaml(package, path):
    with open(os.path.join(get_package_share_directory(package), path)) as file:
        return yaml.safe_load(file)


def generate_launch_description():
    limits = load_yaml("demo_arm", "config/limits.yaml")
    planning = {"robot_description_planning": limits, "planning_pipelines": ["ompl"]}
    controllers = os.path.join(get_package_share_directory("demo_arm"), "config", "arm.yaml")
    return LaunchDescription(
        [
            Node(
                package="tf2_ros",
                executable="static_transform_publisher",
                name="static_transform_publisher",
                output="log",
                arguments=["0.0", "0.0", "0.0", "0.0", "0.0", "0.0", "world", "base_link"],
            ),
            Node(package="robot_state_publisher", executable="robot_state_publisher"),
            Node(package="moveit_ros_move_group", executable="move_group", parameters=[planning]),
            Node(
                package="controller_manager",
                executable="ros2_control_node",
                parameters=[controllers],
            ),
            Node(
                package="controller_manager",
                executable="spawner",
                arguments=["joint_state_broadcaster", "-c", "/controller_manager"],
            ),
        ]
    )
