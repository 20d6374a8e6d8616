# A joystick with its mux and a terminal program in a window, beside a servo node.
# starts: servo
# warns: joy_node is skipped
# warns: twist_mux is skipped
# warns: teleop is skipped
from launch.actions import DeclareLaunchArgument
from launch.conditions import LaunchConfigurationEquals, LaunchConfigurationNotEquals
from launch.substitutions import LaunchConfiguration
from launch_ros.actions import Node

from launch import LaunchDescription


def generate_launch_description():
    return LaunchDescription(
        [
            DeclareLaunchArgument("device", default_value="joy"),
            Node(
                package="joy",
                executable="joy_node",
                parameters=[
                    {"device_id": 0, "deadzone": 0.1, "name": LaunchConfiguration("device")}
                ],
                condition=LaunchConfigurationEquals("device", "joy"),
            ),
            Node(
                package="teleop_twist_joy",
                executable="teleop_node",
                name="teleop",
                condition=LaunchConfigurationNotEquals("device", "keyboard"),
            ),
            Node(
                package="twist_mux", executable="twist_mux", remappings=[("cmd_vel_out", "cmd_vel")]
            ),
            Node(package="demo_arm", executable="servo", respawn=True, respawn_delay=2.0),
        ]
    )
