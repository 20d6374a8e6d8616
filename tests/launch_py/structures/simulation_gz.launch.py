# Gazebo with a bridge, a spawn, and controllers by `ros2 control` in a chain of exits.
# starts: robot_state_publisher gzserver create parameter_bridge
# later: ros2 ros2-2
from launch.actions import (
    AppendEnvironmentVariable,
    DeclareLaunchArgument,
    ExecuteProcess,
    IncludeLaunchDescription,
    RegisterEventHandler,
)
from launch.event_handlers import OnProcessExit
from launch.launch_description_sources import PythonLaunchDescriptionSource
from launch.substitutions import Command, LaunchConfiguration, PathJoinSubstitution
from launch_ros.actions import Node
from launch_ros.substitutions import FindPackageShare

from launch import LaunchDescription


def generate_launch_description():
    share = FindPackageShare("demo_arm")
    text = Command(["xacro ", PathJoinSubstitution([share, "urdf", "arm.urdf.xacro"])])
    spawn = Node(
        package="ros_gz_sim",
        executable="create",
        output="screen",
        arguments=["-topic", "robot_description", "-name", "arm", "-allow_renaming", "true"],
    )
    load = [
        ExecuteProcess(
            cmd=["ros2", "control", "load_controller", "--set-state", "active", name],
            output="screen",
        )
        for name in ("joint_state_broadcaster", "arm_controller")
    ]
    return LaunchDescription(
        [
            AppendEnvironmentVariable("GZ_SIM_RESOURCE_PATH", PathJoinSubstitution([share, ".."])),
            DeclareLaunchArgument("world", default_value="empty.sdf"),
            IncludeLaunchDescription(
                PythonLaunchDescriptionSource(
                    [PathJoinSubstitution([share, "launch", "simulator.launch.py"])]
                ),
                launch_arguments=[("gz_args", [" -r -v 3 ", LaunchConfiguration("world")])],
            ),
            RegisterEventHandler(OnProcessExit(target_action=spawn, on_exit=[load[0]])),
            RegisterEventHandler(OnProcessExit(target_action=load[0], on_exit=[load[1]])),
            Node(
                package="robot_state_publisher",
                executable="robot_state_publisher",
                parameters=[{"use_sim_time": True, "robot_description": text}],
            ),
            spawn,
            Node(
                package="ros_gz_bridge",
                executable="parameter_bridge",
                arguments=["/clock@rosgraph_msgs/msg/Clock[gz.msgs.Clock"],
            ),
        ]
    )
