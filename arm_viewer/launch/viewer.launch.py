"""Start the browser page for whatever is running."""

from launch_py import DeclareLaunchArgument, LaunchDescription, Notified, ReadyPanel
from launch_py.conditions import LaunchConfigurationNotEquals
from launch_py.ros import Node, ParameterValue
from launch_py.substitutions import Call, LaunchConfiguration

LOCAL_HOST = "127.0.0.1"
SWITCH = ["true", "false"]
ARGUMENTS = {
    "viewer_port": ("8080", "port of the page", None),
    "viewer_host": (
        LOCAL_HOST,
        "address that the page listens on; 0.0.0.0 serves other machines, by a token that it "
        "prints",
        None,
    ),
    "viewer_read_only": ("false", "let nobody do more than look at the page", SWITCH),
    "display_config": ("", "RViz configuration that the page shows first", None),
    "publish_joint_states": (
        "false",
        "publish joint states from the page's sliders, without a running robot",
        SWITCH,
    ),
}


def address(host: str, port: str) -> str:
    """Return where the page is; the page itself prints an address with a token."""
    if host == LOCAL_HOST:
        return f"http://{host}:{port}"
    return f"the address with the token, which arm_viewer_node has printed (port {port} of {host})"


def generate_launch_description() -> LaunchDescription:
    """Return the description with the page's node."""
    port, host = LaunchConfiguration("viewer_port"), LaunchConfiguration("viewer_host")
    return LaunchDescription(
        [
            *(
                DeclareLaunchArgument(name, default_value=value, description=text, choices=choices)
                for name, (value, text, choices) in ARGUMENTS.items()
            ),
            Node(
                package="arm_viewer",
                executable="arm_viewer_node",
                parameters=[
                    {
                        "port": ParameterValue(port, value_type=int),
                        "host": ParameterValue(host, value_type=str),
                        "read_only": LaunchConfiguration("viewer_read_only"),
                        "display_config": ParameterValue(
                            LaunchConfiguration("display_config"), value_type=str
                        ),
                        "publish_joint_states": LaunchConfiguration("publish_joint_states"),
                    }
                ],
                ready=Notified(),
            ),
            # Of a port that the page picks, the page itself tells the launch.
            ReadyPanel(
                notes=[("the page", Call(address, host, port))],
                condition=LaunchConfigurationNotEquals("viewer_port", "0"),
            ),
        ]
    )
