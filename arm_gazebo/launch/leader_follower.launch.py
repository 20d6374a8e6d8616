"""Two real arms of one kind: one is moved by hand, the other follows it."""

from launch_py import (
    Action,
    DeclareLaunchArgument,
    Finished,
    IncludeLaunchDescription,
    LaunchDescription,
    Notified,
    ReadyPanel,
    Shutdown,
)
from launch_py.actions import OpaqueFunction
from launch_py.conditions import IfCondition
from launch_py.errors import UsageError
from launch_py.launch_context import LaunchContext
from launch_py.launch_description_sources import PythonLaunchDescriptionSource
from launch_py.ros import FindPackageShare, Node
from launch_py.substitutions import LaunchConfiguration, PathJoinSubstitution

ARGUMENTS = {
    "model_args": ("", 'arguments of a xacro model: "a:=1 b:=2"'),
    "hardware": ("feetech", "hardware of both arms, as in sim.launch.py"),
    "leader_port": ("/dev/ttyUSB0", "serial port of the arm that is moved by hand"),
    "follower_port": ("/dev/ttyUSB1", "serial port of the arm that follows"),
    "leader_calibration": ("", "calibration file of the leader"),
    "follower_calibration": ("", "calibration file of the follower"),
    "hardware_args": ("", 'other <param>s of both hardware plugins: "a:=1 b:=2"'),
}


def arms(context: LaunchContext) -> list[Action]:
    """Return the nodes.

    Raises:
        UsageError: an argument is invalid.
    """
    from arm_description.errors import DescriptionError
    from arm_description.xacro.expansion import arguments_of_text
    from arm_gazebo.errors import GazeboError
    from arm_gazebo.launching.leader_follower import FOLLOWER, LEADER, pair_arms
    from arm_gazebo.launching.robot_setup import set_up_robot

    words = context.launch_configurations
    try:
        common = arguments_of_text(words["hardware_args"])
        ports = {name: {"port": words[f"{name}_port"], **common} for name in (LEADER, FOLLOWER)}
        for name, parameters in ports.items():
            if words[f"{name}_calibration"]:
                parameters["calibration"] = words[f"{name}_calibration"]
        ports[LEADER]["passive"] = "true"
        setup = set_up_robot(words["model"], words["model_args"])
        pair = pair_arms(setup.description, words["hardware"], ports)
    except (DescriptionError, GazeboError) as error:
        raise UsageError(str(error)) from error
    manager = Node(
        package="arm_control",
        executable="ros2_control_node",
        parameters=[pair.controllers],
        ready=Notified(),
        on_exit=Shutdown(),
    )
    return [
        Node(
            package="arm_description",
            executable="robot_state_publisher",
            parameters=[{"robot_description": pair.description}],
            ready=Notified(),
        ),
        manager,
        Node(
            package="arm_control",
            executable="spawner",
            arguments=["joint_state_broadcaster", "leader_follower"],
            ready=Finished(),
            depends_on=manager,
        ),
    ]


def generate_launch_description() -> LaunchDescription:
    """Return the two arms, and the page where it is wanted."""
    model = PathJoinSubstitution([FindPackageShare("arm_description"), "urdf", "arm.urdf.xacro"])
    page = PathJoinSubstitution([FindPackageShare("arm_viewer"), "launch", "viewer.launch.py"])
    return LaunchDescription(
        [
            DeclareLaunchArgument(
                "model", default_value=model, description="URDF or xacro file of one arm"
            ),
            *(
                DeclareLaunchArgument(name, default_value=value, description=about)
                for name, (value, about) in ARGUMENTS.items()
            ),
            DeclareLaunchArgument(
                "viewer",
                default_value="false",
                description="serve the browser page that shows them",
                choices=["true", "false"],
            ),
            OpaqueFunction(function=arms),
            IncludeLaunchDescription(
                PythonLaunchDescriptionSource(page),
                condition=IfCondition(LaunchConfiguration("viewer")),
            ),
            ReadyPanel(
                title="Move the leader by hand; the follower comes slowly, then follows",
                topics=[("/joint_states", "sensor_msgs/msg/JointState, leader_* and follower_*")],
            ),
        ]
    )
