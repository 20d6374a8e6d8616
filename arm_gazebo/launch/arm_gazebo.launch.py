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
from launch_py.conditions import IfCondition, UnlessCondition
from launch_py.launch_description_sources import PythonLaunchDescriptionSource
from launch_py.ros import FindPackageShare, Node, ParameterValue
from launch_py.substitutions import (
    EqualsSubstitution,
    IfElseSubstitution,
    LaunchConfiguration,
    PathJoinSubstitution,
)

OWN_POSE = "arm launch arm_controller arm_controller_node.launch.py interface:=ros1"
IS_ROS1 = EqualsSubstitution(LaunchConfiguration("interface"), "ros1")


def by_interface(ros2: str, ros1: str) -> IfElseSubstitution:
    """Return one of two texts, as the argument `interface` says."""
    return IfElseSubstitution(IS_ROS1, if_value=ros1, else_value=ros2)


def panels() -> list[ReadyPanel]:
    """Return what the user is told, one for each interface."""
    return [
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
            condition=UnlessCondition(IS_ROS1),
        ),
        ReadyPanel(
            title="The arm is up, as in ROS 1",
            topics=[
                ("/arm/j0p_controller/command", "std_msgs/msg/Float64; likewise j1p, j2p, j3p"),
                ("/arm/joint_states", "sensor_msgs/msg/JointState, 50 Hz"),
                ("/arm/videocamera", "sensor_msgs/msg/Image"),
            ],
            commands=[("its own pose", OWN_POSE)],
            condition=IfCondition(IS_ROS1),
        ),
    ]


def generate_launch_description() -> LaunchDescription:
    """Return the world with controllers, and the controller node without a pose."""
    world = PathJoinSubstitution([FindPackageShare("arm_gazebo"), "launch", "arm_world.launch.py"])
    single = ",".join(f"j{i}p_controller" for i in range(4))
    return LaunchDescription(
        [
            DeclareLaunchArgument(
                "interface",
                default_value="ros2",
                choices=["ros2", "ros1"],
                description="one controller of all joints, or as in ROS 1 one for each under /arm",
            ),
            DeclareLaunchArgument(
                "namespace",
                default_value=by_interface("", "arm"),
                description="of all nodes of the robot",
            ),
            DeclareLaunchArgument(
                "spawn",
                default_value=by_interface(
                    "joint_state_broadcaster,position_controller",
                    f"joint_state_broadcaster,{single}",
                ),
                description="controllers to start with the simulation, with commas",
            ),
            IncludeLaunchDescription(
                PythonLaunchDescriptionSource(world),
                launch_arguments={"spawn": LaunchConfiguration("spawn")},
            ),
            Node(
                package="arm_controller",
                executable="arm_controller_node",
                namespace=LaunchConfiguration("namespace"),
                parameters=[
                    {
                        "print_period": 0.0,
                        "command_topic": ParameterValue(
                            by_interface(
                                "position_controller/commands", "{joint}p_controller/command"
                            ),
                            value_type=str,
                        ),
                    }
                ],
                ready=Notified(),
            ),
            *panels(),
        ]
    )
