"""The myCobot picks up the red cylinder and puts it back; the simulation continues."""

from launch_py import DeclareLaunchArgument, IncludeLaunchDescription, LaunchDescription
from launch_py.launch_description_sources import PythonLaunchDescriptionSource
from launch_py.ros import FindPackageShare, Node
from launch_py.substitutions import LaunchConfiguration, PathJoinSubstitution


def generate_launch_description() -> LaunchDescription:
    """Return the simulation with its own arguments, and the node that picks."""
    simulation = PathJoinSubstitution(
        [FindPackageShare("mycobot_gazebo"), "launch", "mycobot.gazebo.launch.py"]
    )
    return LaunchDescription(
        [
            DeclareLaunchArgument(
                "prefix",
                default_value="",
                description="prefix of every link and joint name",
            ),
            DeclareLaunchArgument(
                "hold_time", default_value="5.0", description="how long to hold the cylinder, in s"
            ),
            IncludeLaunchDescription(PythonLaunchDescriptionSource(simulation)),
            Node(
                package="arm_controller",
                executable="mycobot_pick_and_place",
                parameters=[
                    {
                        "use_sim_time": True,
                        "prefix": LaunchConfiguration("prefix"),
                        "hold_time": LaunchConfiguration("hold_time"),
                    }
                ],
            ),
        ]
    )
