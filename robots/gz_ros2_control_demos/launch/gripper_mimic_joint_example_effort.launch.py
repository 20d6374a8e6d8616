"""A gripper whose left finger follows the right one, commanded by a force in N."""

from launch_py import IncludeLaunchDescription, LaunchDescription, ReadyPanel
from launch_py.launch_description_sources import PythonLaunchDescriptionSource
from launch_py.ros import FindPackageShare
from launch_py.substitutions import PathJoinSubstitution


def generate_launch_description() -> LaunchDescription:
    """Return the simulation of any robot, told about this one; its arguments are this file's."""
    share = FindPackageShare("gz_ros2_control_demos")
    simulation = PathJoinSubstitution([FindPackageShare("arm_gazebo"), "launch", "sim.launch.py"])
    return LaunchDescription(
        [
            IncludeLaunchDescription(
                PythonLaunchDescriptionSource(simulation),
                launch_arguments={
                    "model": PathJoinSubstitution([share, "urdf/gripper_mimic_joint.urdf.xacro"]),
                    "model_args": "interface:=effort",
                    "controllers": PathJoinSubstitution([share, "config/gripper_controller.yaml"]),
                },
            ),
            ReadyPanel(
                title="The gripper is up",
                topics=[
                    (
                        "/gripper_controller/commands",
                        "std_msgs/msg/Float64MultiArray, a force in N",
                    ),
                    ("/joint_states", "sensor_msgs/msg/JointState"),
                ],
                commands=[("close", "arm run gz_ros2_control_demos example_gripper")],
            ),
        ]
    )
