"""A double pendulum that swings freely: its joint states, and the page that shows them."""

from launch_py import DeclareLaunchArgument, IncludeLaunchDescription, LaunchDescription, ReadyPanel
from launch_py.launch_description_sources import PythonLaunchDescriptionSource
from launch_py.ros import FindPackageShare
from launch_py.substitutions import PathJoinSubstitution

SWITCH = ["true", "false"]


def generate_launch_description() -> LaunchDescription:
    """Return the simulation of the pendulum."""
    share = FindPackageShare("ros_gz_sim_demos")
    simulation = PathJoinSubstitution([FindPackageShare("arm_gazebo"), "launch", "sim.launch.py"])
    return LaunchDescription(
        [
            DeclareLaunchArgument(
                "viewer", default_value="true", description="open the page", choices=SWITCH
            ),
            IncludeLaunchDescription(
                PythonLaunchDescriptionSource(simulation),
                launch_arguments={
                    "model": PathJoinSubstitution([share, "urdf", "double_pendulum.urdf"]),
                    "spawn": "joint_state_broadcaster",
                    "hold_joints": "false",
                },
            ),
            ReadyPanel(
                title="The pendulum swings",
                topics=[("/joint_states", "sensor_msgs/msg/JointState")],
                commands=[("watch it", "arm topic echo /joint_states")],
            ),
        ]
    )
