"""The main job: the simulated arm with its controllers, the state publisher, the user's node.

The simulation starts the controllers itself, which saves a process and its discovery;
arm_control.launch.py starts them from outside, with the spawner.
"""

from launch_py import (
    DeclareLaunchArgument,
    IncludeLaunchDescription,
    LaunchDescription,
    Notified,
    ReadyPanel,
)
from launch_py.launch_description_sources import PythonLaunchDescriptionSource
from launch_py.ros import FindPackageShare, Node
from launch_py.substitutions import LaunchConfiguration, PathJoinSubstitution


def generate_launch_description() -> LaunchDescription:
    """Return the world with controllers, and the controller node without a pose."""
    world = PathJoinSubstitution([FindPackageShare("arm_gazebo"), "launch", "arm_world.launch.py"])
    return LaunchDescription(
        [
            DeclareLaunchArgument(
                "spawn",
                default_value="joint_state_broadcaster,position_controller",
                description="controllers to start with the simulation, with commas",
            ),
            IncludeLaunchDescription(
                PythonLaunchDescriptionSource(world),
                launch_arguments={"spawn": LaunchConfiguration("spawn")},
            ),
            Node(
                package="arm_controller",
                executable="arm_controller_node",
                parameters=[{"print_period": 0.0}],
                ready=Notified(),
            ),
            ReadyPanel(
                title="The arm is up",
                topics=[
                    ("/position_controller/commands", "std_msgs/msg/Float64MultiArray, j0 to j3"),
                    ("/joint_states", "sensor_msgs/msg/JointState"),
                    ("/videocamera", "sensor_msgs/msg/Image"),
                ],
                commands=[
                    ("type poses", "publisher_terminal"),
                    ("five poses", "publisher_defined"),
                ],
            ),
        ]
    )
