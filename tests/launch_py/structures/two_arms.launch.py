# Groups with pushed namespaces, remaps and parameters of all nodes inside.
# starts: robot_state_publisher driver robot_state_publisher-2 driver-2
from launch.actions import GroupAction
from launch_ros.actions import Node, PushRosNamespace, SetParameter, SetRemap

from launch import LaunchDescription


def generate_launch_description():
    def arm(name):
        return GroupAction(
            actions=[
                PushRosNamespace(name),
                SetRemap(src="/tf", dst="tf"),
                SetParameter(name="use_sim_time", value=True),
                Node(
                    package="robot_state_publisher",
                    executable="robot_state_publisher",
                    parameters=[{"frame_prefix": f"{name}/"}],
                ),
                Node(
                    package="demo_arm", executable="driver", parameters=[{"port": "/dev/ttyUSB0"}]
                ),
            ]
        )

    return LaunchDescription([arm("left"), arm("right")])
