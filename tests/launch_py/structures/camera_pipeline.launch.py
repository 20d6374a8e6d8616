# A container of image components behind a camera driver, and a detector of its own.
# starts: detector
# warns: camera is skipped
# warns: image_proc::RectifyNode of image_proc is skipped
from launch_ros.actions import ComposableNodeContainer, Node
from launch_ros.descriptions import ComposableNode

from launch import LaunchDescription


def generate_launch_description():
    return LaunchDescription(
        [
            Node(package="realsense2_camera", executable="realsense2_camera_node", name="camera"),
            ComposableNodeContainer(
                name="image_container",
                namespace="",
                package="rclcpp_components",
                executable="component_container_mt",
                composable_node_descriptions=[
                    ComposableNode(
                        package="image_proc",
                        plugin="image_proc::RectifyNode",
                        name="rectify",
                        remappings=[("image", "/camera/color/image_raw")],
                        extra_arguments=[{"use_intra_process_comms": True}],
                    )
                ],
                output="screen",
            ),
            Node(
                package="demo_arm",
                executable="detector",
                remappings={"image": "image_rect"}.items(),
            ),
        ]
    )
