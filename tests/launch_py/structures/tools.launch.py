# What people start beside a robot: relays, bridges for browsers, plots, frames.
# starts: monitor frames rqt_graph
# warns: relay is skipped
# warns: foxglove_bridge is skipped
# warns: rosbridge_websocket is skipped
# warns: republish is skipped
# warns: plotjuggler is skipped
# warns: rqt is skipped
from launch.actions import ExecuteProcess
from launch_ros.actions import Node

from launch import LaunchDescription


def generate_launch_description():
    return LaunchDescription(
        [
            Node(package="topic_tools", executable="relay", arguments=["/a", "/b"]),
            Node(
                package="foxglove_bridge", executable="foxglove_bridge", parameters=[{"port": 8765}]
            ),
            Node(package="rosbridge_server", executable="rosbridge_websocket"),
            Node(
                package="image_transport", executable="republish", arguments=["raw", "compressed"]
            ),
            Node(package="plotjuggler", executable="plotjuggler"),
            ExecuteProcess(cmd=["rqt", "--force-discover"]),
            Node(package="tf2_ros", executable="tf2_monitor", name="monitor"),
            Node(package="tf2_tools", executable="view_frames", name="frames"),
            Node(package="rqt_graph", executable="rqt_graph", name="rqt_graph"),
        ]
    )
