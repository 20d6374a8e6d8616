# The chain of ros2_control's demos: broadcaster, then the window, then the controller.
# starts: ros2_control_node robot_state_publisher spawner
# later: rviz2 spawner-2
from launch.actions import DeclareLaunchArgument, RegisterEventHandler
from launch.conditions import IfCondition
from launch.event_handlers import OnProcessExit
from launch.substitutions import Command, FindExecutable, LaunchConfiguration, PathJoinSubstitution
from launch_ros.actions import Node
from launch_ros.substitutions import FindPackageShare

from launch import LaunchDescription


def generate_launch_description():
    gui = LaunchConfiguration("gui")
    text = Command(
        [
            PathJoinSubstitution([FindExecutable(name="xacro")]),
            " ",
            PathJoinSubstitution([FindPackageShare("demo_arm"), "urdf", "arm.urdf.xacro"]),
        ]
    )
    controllers = PathJoinSubstitution([FindPackageShare("demo_arm"), "config", "arm.yaml"])
    control = Node(
        package="controller_manager",
        executable="ros2_control_node",
        parameters=[controllers],
        remappings=[("~/robot_description", "/robot_description")],
        output="both",
    )
    publisher = Node(
        package="robot_state_publisher",
        executable="robot_state_publisher",
        output="both",
        parameters=[{"robot_description": text}],
    )
    window = Node(
        package="rviz2", executable="rviz2", name="rviz2", output="log", condition=IfCondition(gui)
    )
    broadcaster = Node(
        package="controller_manager", executable="spawner", arguments=["joint_state_broadcaster"]
    )
    controller = Node(
        package="controller_manager",
        executable="spawner",
        arguments=["forward_position_controller", "--param-file", controllers],
    )
    return LaunchDescription(
        [
            DeclareLaunchArgument("gui", default_value="true"),
            control,
            publisher,
            broadcaster,
            RegisterEventHandler(
                event_handler=OnProcessExit(target_action=broadcaster, on_exit=[window])
            ),
            RegisterEventHandler(
                event_handler=OnProcessExit(target_action=broadcaster, on_exit=[controller])
            ),
        ]
    )
