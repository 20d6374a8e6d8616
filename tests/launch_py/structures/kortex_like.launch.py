# Parameters by nested dicts, files and overrides; a spawner for each of several controllers.
# starts: ros2_control_node spawner spawner-2
# warns: rqt_joint_trajectory_controller is skipped
from launch.substitutions import PathJoinSubstitution
from launch_ros.actions import Node, SetParametersFromFile, SetUseSimTime
from launch_ros.descriptions import Parameter
from launch_ros.substitutions import FindPackageShare

from launch import LaunchDescription


def generate_launch_description():
    file = PathJoinSubstitution([FindPackageShare("demo_arm"), "config", "arm.yaml"])
    return LaunchDescription(
        [
            SetUseSimTime(False),
            SetParametersFromFile(file),
            Node(
                package="controller_manager",
                executable="ros2_control_node",
                parameters=[
                    {
                        "update_rate": 1000,
                        "hardware": {"arm": {"ip": "192.168.1.10", "ports": [1, 2]}},
                    },
                    file,
                    Parameter("lock_memory", False),
                ],
                prefix=["nice -n 5"],
                ros_arguments=["--log-level", "warn"],
            ),
            *(
                Node(
                    package="controller_manager",
                    executable="spawner",
                    arguments=[name, "--inactive"],
                )
                for name in ("twist_controller", "arm_controller")
            ),
            Node(
                package="rqt_joint_trajectory_controller",
                executable="rqt_joint_trajectory_controller",
            ),
        ]
    )
