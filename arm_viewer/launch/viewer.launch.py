"""The page in the browser, beside whatever runs."""

from launch_py import DeclareLaunchArgument, LaunchDescription, Notified, ReadyPanel
from launch_py.ros import Node, ParameterValue
from launch_py.substitutions import LaunchConfiguration


def generate_launch_description() -> LaunchDescription:
    """Return the page's node."""
    port = LaunchConfiguration("viewer_port")
    return LaunchDescription(
        [
            DeclareLaunchArgument(
                "viewer_port", default_value="8080", description="of the page, on 127.0.0.1"
            ),
            DeclareLaunchArgument(
                "publish_joint_states",
                default_value="false",
                description="by the page's sliders, for a robot that is not there",
                choices=["true", "false"],
            ),
            Node(
                package="arm_viewer",
                executable="arm_viewer_node",
                parameters=[
                    {
                        "port": ParameterValue(port, value_type=int),
                        "publish_joint_states": LaunchConfiguration("publish_joint_states"),
                    }
                ],
                ready=Notified(),
            ),
            ReadyPanel(notes=[("the page", ["http://127.0.0.1:", port])]),
        ]
    )
