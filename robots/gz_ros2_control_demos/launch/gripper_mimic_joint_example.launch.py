"""A gripper whose left finger mimics the right one, commanded by force or position."""

from launch_py import (
    DeclareLaunchArgument,
    IncludeLaunchDescription,
    LaunchDescription,
    ReadyPanel,
)
from launch_py.conditions import LaunchConfigurationEquals
from launch_py.launch_description_sources import PythonLaunchDescriptionSource
from launch_py.ros import FindPackageShare
from launch_py.substitutions import Call, LaunchConfiguration, PathJoinSubstitution

UNITS = {"effort": "a force in N", "position": "a position in m"}


def command(interface: str) -> str:
    """Return the type and unit of the controller's commands."""
    return f"std_msgs/msg/Float64MultiArray, {UNITS[interface]}"


def generate_launch_description() -> LaunchDescription:
    """Return sim.launch.py with this robot; its other arguments are available here as well."""
    share = FindPackageShare("gz_ros2_control_demos")
    simulation = PathJoinSubstitution([FindPackageShare("arm_gazebo"), "launch", "sim.launch.py"])
    interface = LaunchConfiguration("interface")
    return LaunchDescription(
        [
            DeclareLaunchArgument(
                "interface",
                default_value="effort",
                description="command interface of the right finger",
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
                condition=LaunchConfigurationEquals("copies", "1"),
            ),
        ]
    )
