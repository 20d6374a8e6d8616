"""A world without a robot, by Gazebo's own words: gz_args:="shapes.sdf"."""

from launch_py import (
    Action,
    DeclareLaunchArgument,
    IncludeLaunchDescription,
    LaunchDescription,
    LogInfo,
    ReadyPanel,
)
from launch_py.actions import OpaqueFunction
from launch_py.launch_context import LaunchContext
from launch_py.launch_description_sources import PythonLaunchDescriptionSource
from launch_py.ros import FindPackageShare
from launch_py.substitutions import PathJoinSubstitution

RUN = "-r"


def run_at_once(context: LaunchContext) -> list[Action]:
    """Take words without -r, too: a world in which nobody does anything need not wait for it."""
    words = context.launch_configurations["gz_args"]
    if not words.strip() or RUN in words.split():
        return []
    context.launch_configurations["gz_args"] = f"{RUN} {words}"
    return [LogInfo(msg=f"gz_args lacks {RUN}: the world runs from its start all the same")]


def generate_launch_description() -> LaunchDescription:
    """Return the simulation of any robot; here it is a camera that looks on."""
    simulation = PathJoinSubstitution([FindPackageShare("arm_gazebo"), "launch", "sim.launch.py"])
    spectator = PathJoinSubstitution([FindPackageShare("ros_gz_sim"), "urdf", "spectator.urdf"])
    return LaunchDescription(
        [
            DeclareLaunchArgument(
                "gz_args", default_value="", description='Gazebo\'s words: "-r -v 4 shapes.sdf"'
            ),
            OpaqueFunction(function=run_at_once),
            IncludeLaunchDescription(
                PythonLaunchDescriptionSource(simulation),
                launch_arguments={"model": spectator, "spawn": ""},
            ),
            ReadyPanel(
                title="The world is up",
                topics=[
                    ("/videocamera", "sensor_msgs/msg/Image"),
                    ("/clock", "rosgraph_msgs/msg/Clock"),
                ],
            ),
        ]
    )
