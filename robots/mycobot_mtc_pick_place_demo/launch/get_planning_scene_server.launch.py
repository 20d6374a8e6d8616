"""The service /get_planning_scene_mycobot, beside a myCobot that runs with use_camera:=true."""

from importlib.util import find_spec

from launch_py import Action, DeclareLaunchArgument, LaunchDescription, Notified, ReadyPanel
from launch_py.actions import OpaqueFunction
from launch_py.errors import UsageError
from launch_py.launch_context import LaunchContext
from launch_py.ros import FindPackageShare, Node
from launch_py.substitutions import LaunchConfiguration, PathJoinSubstitution

PACKAGE = "mycobot_mtc_pick_place_demo"


def server(_: LaunchContext) -> list[Action]:
    """Return the node.

    Raises:
        UsageError: its messages are not installed.
    """
    if find_spec("mycobot_interfaces") is None:
        raise UsageError("seeing needs mycobot_interfaces: pip install ./arm_moveit_interfaces")
    settings = PathJoinSubstitution(
        [FindPackageShare(PACKAGE), "config", "get_planning_scene_server.yaml"]
    )
    return [
        Node(
            package=PACKAGE,
            executable="get_planning_scene_server",
            parameters=[settings, {"use_sim_time": LaunchConfiguration("use_sim_time")}],
            ready=Notified(),
        ),
        ReadyPanel(
            title="The camera's scene can be asked for",
            commands=[
                (
                    "what is seen",
                    "arm service call /get_planning_scene_mycobot "
                    "mycobot_interfaces/srv/GetPlanningScene "
                    '"{target_shape: cylinder, target_dimensions: [0.35, 0.0125]}"',
                )
            ],
        ),
    ]


def generate_launch_description() -> LaunchDescription:
    """Return the node and its argument."""
    return LaunchDescription(
        [
            DeclareLaunchArgument(
                "use_sim_time",
                default_value="true",
                choices=["true", "false"],
                description="the node uses simulation time",
            ),
            OpaqueFunction(function=server),
        ]
    )
