"""mtc_node: picks up what the camera sees; needs move_group and get_planning_scene_server."""

from launch_py import DeclareLaunchArgument, LaunchDescription
from launch_py.ros import FindPackageShare, Node
from launch_py.substitutions import LaunchConfiguration, PathJoinSubstitution


def generate_launch_description() -> LaunchDescription:
    """Return the node and its arguments."""
    configuration = PathJoinSubstitution(
        [FindPackageShare("mycobot_moveit_config"), "config", LaunchConfiguration("robot_name")]
    )
    return LaunchDescription(
        [
            DeclareLaunchArgument(
                "robot_name",
                default_value="mycobot_280",
                description="robot whose configuration is taken",
            ),
            DeclareLaunchArgument(
                "use_sim_time",
                default_value="true",
                choices=["true", "false"],
                description="the node uses simulation time",
            ),
            DeclareLaunchArgument(
                "exe",
                default_value="mtc_node",
                choices=["mtc_node"],
                description="the program",
            ),
            DeclareLaunchArgument(
                "execute",
                default_value="false",
                choices=["true", "false"],
                description="move the robot; otherwise the plan is only shown",
            ),
            Node(
                package="mycobot_mtc_pick_place_demo",
                executable=LaunchConfiguration("exe"),
                parameters=[
                    {
                        "use_sim_time": LaunchConfiguration("use_sim_time"),
                        "execute": LaunchConfiguration("execute"),
                        "moveit_config": configuration,
                    }
                ],
            ),
        ]
    )
