"""Send every TFMessage back on another topic, with the frames of each transform swapped."""

import peer
from rclpy.node import Node
from tf2_msgs.msg import TFMessage


def create(node: Node) -> None:
    """Listen on /there, answer on /back."""
    publisher = node.create_publisher(TFMessage, "/back", 10)

    def echo(message: TFMessage) -> None:
        for transform in message.transforms:
            parent, child = transform.header.frame_id, transform.child_frame_id
            transform.header.frame_id, transform.child_frame_id = child, parent
        publisher.publish(message)

    node.create_subscription(TFMessage, "/there", echo, 10)


if __name__ == "__main__":
    peer.run("tf_echo", create)
