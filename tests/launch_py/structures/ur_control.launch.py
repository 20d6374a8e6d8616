# An OpaqueFunction that reads arguments, spawners in a loop, a mock or a real driver by condition.
# starts: ros2_control_node robot_state_publisher dashboard_client rviz2 joint_state_broadcaster
# starts: forward_position_controller
# arguments: use_mock_hardware:=true
from launch.actions import DeclareLaunchArgument, OpaqueFunction
from launch.conditions import IfCondition, UnlessCondition
from launch.substitutions import (
    AndSubstitution,
    Command,
    FindExecutable,
    LaunchConfiguration,
    NotSubstitution,
    PathJoinSubstitution,
)
from launch_ros.actions import Node
from launch_ros.parameter_descriptions import ParameterFile, ParameterValue
from launch_ros.substitutions import FindPackageShare

from launch import LaunchDescription


def launch_setup(context):
    mock = LaunchConfiguration("use_mock_hardware")
    description = Command(
        [
            PathJoinSubstitution([FindExecutable(name="xacro")]),
            " ",
            PathJoinSubstitution([FindPackageShare("demo_arm"), "urdf", "arm.urdf.xacro"]),
            " name:=",
            LaunchConfiguration("arm_type"),
        ]
    )
    robot = {"robot_description": ParameterValue(value=description, value_type=str)}
    controllers = PathJoinSubstitution([FindPackageShare("demo_arm"), "config", "arm.yaml"])
    nodes = [
        Node(
            package="controller_manager",
            executable="ros2_control_node",
            parameters=[robot, ParameterFile(controllers, allow_substs=True)],
            output="screen",
            condition=IfCondition(mock),
        ),
        Node(package="demo_arm", executable="driver", condition=UnlessCondition(mock)),
        Node(
            package="robot_state_publisher", executable="robot_state_publisher", parameters=[robot]
        ),
        Node(
            package="demo_arm",
            executable="dashboard",
            name="dashboard_client",
            emulate_tty=True,
            parameters=[{"robot_ip": LaunchConfiguration("robot_ip")}],
            condition=IfCondition(AndSubstitution(mock, NotSubstitution("false"))),
        ),
        Node(package="rviz2", executable="rviz2", name="rviz2", arguments=["-d", "view.rviz"]),
    ]
    active = ["joint_state_broadcaster", LaunchConfiguration("initial").perform(context)]
    spawners = [
        Node(
            package="controller_manager",
            executable="spawner",
            name=name,
            arguments=[name, "--controller-manager", "/controller_manager"],
        )
        for name in active
    ]
    return nodes + spawners


def generate_launch_description():
    declared = [
        DeclareLaunchArgument("arm_type", default_value="arm", choices=["arm", "big_arm"]),
        DeclareLaunchArgument("robot_ip", default_value="127.0.0.1"),
        DeclareLaunchArgument("use_mock_hardware", default_value="false"),
        DeclareLaunchArgument("initial", default_value="forward_position_controller"),
    ]
    return LaunchDescription([*declared, OpaqueFunction(function=launch_setup)])
