"""The simulated ROSMASTER X3: it drives ahead, sideways and turns, all at once."""

from launch_py import IncludeLaunchDescription, LaunchDescription, ReadyPanel
from launch_py.conditions import LaunchConfigurationEquals
from launch_py.launch_description_sources import PythonLaunchDescriptionSource
from launch_py.ros import FindPackageShare
from launch_py.substitutions import PathJoinSubstitution

REFERENCE = (
    "arm topic pub /mecanum_drive_controller/reference geometry_msgs/msg/TwistStamped "
    '"{twist: {linear: {y: 0.2}}}" --rate 10'
)


def generate_launch_description() -> LaunchDescription:
    """Return the simulation of any robot, told about this one; its arguments are this file's."""
    simulation = PathJoinSubstitution([FindPackageShare("arm_gazebo"), "launch", "sim.launch.py"])
    model = "urdf/robots/rosmaster_x3.urdf.xacro"
    return LaunchDescription(
        [
            IncludeLaunchDescription(
                PythonLaunchDescriptionSource(simulation),
                launch_arguments={
                    "model": PathJoinSubstitution(
                        [FindPackageShare("yahboom_rosmaster_description"), model]
                    ),
                    "model_args": "use_gazebo:=true",
                    "controllers": PathJoinSubstitution(
                        [
                            FindPackageShare("yahboom_rosmaster_gazebo"),
                            "config/ros2_controllers.yaml",
                        ]
                    ),
                    "base": "free",
                },
            ),
            ReadyPanel(
                title="The ROSMASTER X3 is up",
                topics=[
                    ("/mecanum_drive_controller/reference", "geometry_msgs/msg/TwistStamped"),
                    ("/mecanum_drive_controller/odometry", "nav_msgs/msg/Odometry"),
                    ("/tf", "odom to base_footprint"),
                ],
                commands=[("to the left", REFERENCE)],
                condition=LaunchConfigurationEquals("copies", "1"),
            ),
        ]
    )
