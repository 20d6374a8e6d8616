"""A world without a robot, by Gazebo's own words: gz_args:="shapes.sdf".

In a launch file that spawns a robot by ros_gz_sim's `create`, the world waits for it.
"""

from launch_py import (
    Action,
    DeclareLaunchArgument,
    GroupAction,
    IncludeLaunchDescription,
    LaunchDescription,
    LogInfo,
    ReadyPanel,
    SetLaunchConfiguration,
    Shutdown,
)
from launch_py.actions import OpaqueFunction
from launch_py.conditions import IfCondition, UnlessCondition
from launch_py.errors import UsageError
from launch_py.launch_context import LaunchContext
from launch_py.launch_description_sources import PythonLaunchDescriptionSource
from launch_py.ros import FindPackageShare, Node
from launch_py.substitution import describe_text
from launch_py.substitutions import LaunchConfiguration, PathJoinSubstitution

RUN = "-r"
SPAWNERS = ("ros_gz_sim", "ros_ign_gazebo")
WAITS = "world_waits_for_robot"
SPECTATOR_POSE = "spectator_pose"
SETTINGS = ("real_time_factor", "physics_step", "self_collide", "strict", "render_backend")
"""Arguments of sim.launch.py that also apply to a world that waits for its robot."""

SPECTATOR_POSES = {"house": "xyz:='0 -13 15' rpy:='0 0.9 1.5708'"}
"""Where the camera hangs in a world whose walls would hide it: above them."""

TAKEN = {"gz_version": "8", "on_exit_shutdown": "true"}
UNUSED = "accepted as in ROS without effect: the launch ends with its simulation"


def run_at_once(context: LaunchContext) -> list[Action]:
    """Accept options without -r: a world without a robot need not start paused."""
    words = context.launch_configurations["gz_args"]
    if not words.strip() or RUN in words.split():
        return []
    context.launch_configurations["gz_args"] = f"{RUN} {words}"
    return [LogInfo(msg=f"gz_args lacks {RUN}: the world starts running anyway")]


def creates_robot(action: object) -> bool:
    """Return whether an action is ros_gz_sim's `create`."""
    return (
        isinstance(action, Node)
        and action.package is not None
        and describe_text(action.package) in SPAWNERS
        and describe_text(action.executable) == "create"
    )


def look_for_robot(context: LaunchContext) -> list[Action]:
    """Return the setting for whether the launch file spawns a robot."""
    waits = any(map(creates_robot, context.plan.surveyed_actions))
    return [SetLaunchConfiguration(WAITS, str(waits).lower())]


def place_spectator(context: LaunchContext) -> list[Action]:
    """Return the setting for the pose of the camera that observes the world."""
    from arm_gazebo.errors import GazeboError
    from arm_gazebo.launching.gz_arguments import launch_arguments

    words = context.launch_configurations
    try:
        world = launch_arguments(words["gz_args"]).get("world") or words.get("world", "")
    except GazeboError:
        # sim.launch.py reports it.
        world = ""
    return [SetLaunchConfiguration(SPECTATOR_POSE, SPECTATOR_POSES.get(world, ""))]


def world_that_waits(context: LaunchContext) -> list[Action]:
    """Return the node that simulates the robot that `create` spawns.

    Raises:
        UsageError: a word of gz_args means nothing here.
    """
    from arm_gazebo.errors import GazeboError
    from arm_gazebo.launching.gz_arguments import launch_arguments
    from arm_gazebo.launching.world_path import find_world

    words = context.launch_configurations
    settings = {name: LaunchConfiguration(name) for name in SETTINGS if name in words}
    try:
        given = launch_arguments(words["gz_args"])
        find_world(given.get("world", "empty"))
    except GazeboError as error:
        raise UsageError(str(error)) from error
    headless = given.get("headless", words.get("headless", "true")) != "false"
    parameters = {**settings, "world": given.get("world", "empty"), "headless": headless}
    return [
        Node(
            package="arm_gazebo",
            executable="gz_sim_server",
            exec_name="gz_sim",
            parameters=[{"arm_gazebo": {"ros__parameters": parameters}}],
            ros_arguments=["--log-level", given.get("log_level", "info")],
            on_exit=Shutdown(),
        )
    ]


def generate_launch_description() -> LaunchDescription:
    """Return the simulation; its robot is a camera that observes the world."""
    simulation = PathJoinSubstitution([FindPackageShare("arm_gazebo"), "launch", "sim.launch.py"])
    spectator = PathJoinSubstitution(
        [FindPackageShare("ros_gz_sim"), "urdf", "spectator.urdf.xacro"]
    )
    return LaunchDescription(
        [
            DeclareLaunchArgument(
                "gz_args", default_value="", description='Gazebo\'s options: "-r -v 4 shapes.sdf"'
            ),
            *(
                DeclareLaunchArgument(name, default_value=default, description=UNUSED)
                for name, default in TAKEN.items()
            ),
            OpaqueFunction(function=run_at_once),
            OpaqueFunction(function=look_for_robot),
            OpaqueFunction(function=place_spectator),
            OpaqueFunction(
                function=world_that_waits, condition=IfCondition(LaunchConfiguration(WAITS))
            ),
            GroupAction(
                [
                    IncludeLaunchDescription(
                        PythonLaunchDescriptionSource(simulation),
                        launch_arguments={
                            "model": spectator,
                            "model_args": LaunchConfiguration(SPECTATOR_POSE, default=""),
                            "spawn": "",
                        },
                    ),
                    ReadyPanel(
                        title="The world is up",
                        topics=[
                            ("/videocamera", "sensor_msgs/msg/Image"),
                            ("/clock", "rosgraph_msgs/msg/Clock"),
                        ],
                    ),
                ],
                condition=UnlessCondition(LaunchConfiguration(WAITS)),
            ),
        ]
    )
