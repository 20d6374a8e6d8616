"""Start the browser page for whatever is running."""

from launch_py import DeclareLaunchArgument, LaunchDescription, Notified, ReadyPanel
from launch_py.ros import Node, ParameterValue
from launch_py.substitutions import LaunchConfiguration


def generate_launch_description() -> LaunchDescription:
    """Return the description with the page's node."""
    port = LaunchConfiguration("viewer_port")
    return LaunchDescription(
        [
            DeclareLaunchArgument(
                "viewer_port", default_value="8080", description="port of the page on 127.0.0.1"
            ),
            DeclareLaunchArgument(
                "display_config",
                default_value="",
                description="RViz configuration that the page shows first",
            ),
            DeclareLaunchArgument(
                "publish_joint_states",
                default_value="false",
                description="publish joint states from the page's sliders, without a running robot",
                choices=["true", "false"],
            ),
            Node(
                package="arm_viewer",
                executable="arm_viewer_node",
                parameters=[
                    {
                        "port": ParameterValue(port, value_type=int),
                        "display_config": ParameterValue(
                            LaunchConfiguration("display_config"), value_type=str
                        ),
                        "publish_joint_states": LaunchConfiguration("publish_joint_states"),
                    }
                ],
                ready=Notified(),
            ),
            ReadyPanel(notes=[("the page", ["http://127.0.0.1:", port])]),
        ]
    )
