"""The main launch file: the simulated arm, its controllers, the state publisher, the user's node.

The simulation itself starts the controllers, which saves a process and its discovery.
arm_control.launch.py starts them from outside, with the spawner.
"""

from arm_control.course import COURSE_ARGUMENT, INTERFACE_ARGUMENT, take_course
from launch_py import (
    DeclareLaunchArgument,
    IncludeLaunchDescription,
    LaunchDescription,
    LogLine,
    ReadyPanel,
)
from launch_py.actions import OpaqueFunction
from launch_py.conditions import IfCondition
from launch_py.errors import UsageError
from launch_py.launch_context import LaunchContext
from launch_py.launch_description_sources import PythonLaunchDescriptionSource
from launch_py.ros import FindPackageShare, Node, ParameterValue
from launch_py.substitution import Text
from launch_py.substitutions import (
    AndSubstitution,
    EqualsSubstitution,
    IfElseSubstitution,
    LaunchConfiguration,
    NotSubstitution,
    OrSubstitution,
    PathJoinSubstitution,
)

OWN_POSE = "arm launch arm_controller arm_controller_node.launch.py interface:=ros1 replace:=true"
IS_ROS1 = EqualsSubstitution(LaunchConfiguration("interface"), "ros1")
OF_FILE = EqualsSubstitution(LaunchConfiguration("spawn"), "auto")
IS_ALONE = EqualsSubstitution(LaunchConfiguration("copies"), "1")
IS_PLANNED = EqualsSubstitution(LaunchConfiguration("planning", default="false"), "true")
TAKES_POSITIONS = NotSubstitution(OrSubstitution(OF_FILE, IS_PLANNED))
HAS_CAMERA = NotSubstitution(EqualsSubstitution(LaunchConfiguration("camera", default=""), "none"))
"""These two arguments are declared in included files."""


def by_interface(ros2: Text, ros1: Text) -> IfElseSubstitution:
    """Return one of two texts, selected by the argument `interface`."""
    return IfElseSubstitution(IS_ROS1, if_value=ros1, else_value=ros2)


def panels() -> list[ReadyPanel]:
    """Return the panels shown to the user; sim.launch.py has that of copies."""
    is_ros1 = AndSubstitution(IS_ALONE, IS_ROS1)
    is_ros2 = AndSubstitution(IS_ALONE, NotSubstitution(IS_ROS1))
    return [
        ReadyPanel(
            title="The arm is up",
            topics=[("/position_controller/commands", "std_msgs/msg/Float64MultiArray, j0 to j3")],
            commands=[
                ("type poses", "publisher_terminal"),
                ("five poses", "publisher_defined"),
            ],
            condition=IfCondition(AndSubstitution(is_ros2, TAKES_POSITIONS)),
        ),
        ReadyPanel(
            title="The arm is up",
            topics=[("/joint_states", "sensor_msgs/msg/JointState")],
            condition=IfCondition(is_ros2),
        ),
        ReadyPanel(
            topics=[("/videocamera", "sensor_msgs/msg/Image")],
            condition=IfCondition(AndSubstitution(is_ros2, HAS_CAMERA)),
        ),
        ReadyPanel(
            title="The arm is up, as in ROS 1",
            topics=[
                ("/arm/j0p_controller/command", "std_msgs/msg/Float64; likewise j1p, j2p, j3p"),
                ("/arm/joint_states", "sensor_msgs/msg/JointState, 50 Hz"),
            ],
            commands=[("its own pose", OWN_POSE)],
            condition=IfCondition(is_ros1),
        ),
        ReadyPanel(
            topics=[("/camera/image_raw", "sensor_msgs/msg/Image, 800x800")],
            condition=IfCondition(AndSubstitution(is_ros1, HAS_CAMERA)),
        ),
    ]


def check_controller_node(context: LaunchContext) -> None:
    """Refuse the controller node beside copies of the arm.

    Raises:
        UsageError: the user asks for both.
    """
    words = context.launch_configurations
    if words["controller_node"] == "true" and words["copies"] != "1":
        raise UsageError(
            "controller_node:=true is for one arm; with copies:= start it for one of them: "
            "arm launch arm_controller arm_controller_node.launch.py namespace:=NAME"
        )


def controller_node() -> Node:
    """Return the controller node without a pose."""
    return Node(
        package="arm_controller",
        executable="arm_controller_node",
        namespace=LaunchConfiguration("namespace"),
        parameters=[
            {
                "print_period": 0.0,
                "command_topic": ParameterValue(
                    by_interface("position_controller/commands", "{joint}p_controller/command"),
                    value_type=str,
                ),
            }
        ],
        ready=LogLine("Set the parameter desired_param"),
        condition=IfCondition(LaunchConfiguration("controller_node")),
    )


def start_those_of_the_file(context: LaunchContext) -> None:
    """Start the controllers of a file that the user gives, unless `spawn` names some."""
    if "controllers" in context.launch_configurations:
        context.launch_configurations.setdefault("spawn", "auto")


def generate_launch_description() -> LaunchDescription:
    """Return the world with controllers, and the controller node without a pose."""
    world = PathJoinSubstitution([FindPackageShare("arm_gazebo"), "launch", "arm_world.launch.py"])
    single = ",".join(f"j{i}p_controller" for i in range(4))
    return LaunchDescription(
        [
            OpaqueFunction(function=start_those_of_the_file),
            DeclareLaunchArgument("course", **COURSE_ARGUMENT),
            OpaqueFunction(function=take_course),
            DeclareLaunchArgument("interface", **INTERFACE_ARGUMENT),
            DeclareLaunchArgument(
                "robot_name",
                default_value="arm",
                description="with interface:=ros1, the namespace of all nodes of the robot",
            ),
            DeclareLaunchArgument(
                "namespace",
                default_value=by_interface("", LaunchConfiguration("robot_name")),
                description="namespace of all nodes of the robot",
            ),
            DeclareLaunchArgument(
                "spawn",
                default_value=by_interface(
                    IfElseSubstitution(
                        IS_PLANNED,
                        if_value="joint_state_broadcaster,joint_trajectory_controller",
                        else_value="joint_state_broadcaster,position_controller",
                    ),
                    f"joint_state_broadcaster,{single}",
                ),
                description="controllers to start with the simulation, separated by commas; with "
                "controllers:=FILE those of the file",
            ),
            DeclareLaunchArgument(
                "copies",
                default_value="1",
                description="copies of the arm in one world, in the namespaces arm_0, arm_1 and so "
                "on",
            ),
            DeclareLaunchArgument(
                "controller_node",
                default_value=IfElseSubstitution(
                    AndSubstitution(IS_ALONE, NotSubstitution(IS_PLANNED)),
                    if_value="true",
                    else_value="false",
                ),
                description="start arm_controller_node too, without a pose; by default not with "
                "copies or planning",
                choices=["true", "false"],
            ),
            OpaqueFunction(function=check_controller_node),
            IncludeLaunchDescription(
                PythonLaunchDescriptionSource(world),
                launch_arguments={"spawn": LaunchConfiguration("spawn")},
            ),
            controller_node(),
            *panels(),
        ]
    )
