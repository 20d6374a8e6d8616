"""A gripper whose left finger follows the right one, commanded by force or by place."""

from launch_py import (
    DeclareLaunchArgument,
    IncludeLaunchDescription,
    LaunchDescription,
    ReadyPanel,
)
from launch_py.launch_description_sources import PythonLaunchDescriptionSource
from launch_py.ros import FindPackageShare
from launch_py.substitutions import Call, LaunchConfiguration, PathJoinSubstitution

UNITS = {"effort": "a force in N", "position": "a place in m"}


def command(interface: str) -> str:
    """Return what the controller takes."""
    return f"std_msgs/msg/Float64MultiArray, {UNITS[interface]}"


def generate_launch_description() -> LaunchDescription:
    """Return the simulation of any robot, told about this one; its arguments are this file's."""
    share = FindPackageShare("gz_ros2_control_demos")
    simulation = PathJoinSubstitution([FindPackageShare("arm_gazebo"), "launch", "sim.launch.py"])
    interface = LaunchConfiguration("interface")
    return LaunchDescription(
        [
            DeclareLaunchArgument(
                "interface",
                default_value="effort",
                description="what is commanded",
                choices=list(UNITS),
            ),
            IncludeLaunchDescription(
                PythonLaunchDescriptionSource(simulation),
                launch_arguments={
                    "model": PathJoinSubstitution([share, "urdf/gripper_mimic_joint.urdf.xacro"]),
                    "model_args": ["interface:=", interface],
                    "controllers": PathJoinSubstitution([share, "config/gripper_controller.yaml"]),
                },
            ),
            ReadyPanel(
                title="The gripper is up",
                topics=[
                    ("/gripper_controller/commands", Call(command, interface)),
                    ("/joint_states", "sensor_msgs/msg/JointState"),
                ],
                commands=[("close", "arm run gz_ros2_control_demos example_gripper")],
            ),
        ]
    )
