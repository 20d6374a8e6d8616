"""The executable static_transform_publisher: one latched transform on /tf_static."""

import math
import random
import string
import sys
from collections.abc import Iterator, Mapping, Sequence
from contextlib import contextmanager
from typing import TYPE_CHECKING, Any

from arm_description.errors import DescriptionError, SettingsError
from arm_description.publishers.static_transform import USAGE, parameters_of, unit_quaternion
from arm_node.parameter_values import ParameterValueError, Reader, read_number, read_text
from arm_node.process import NodeProcess, run_process

if TYPE_CHECKING:
    from rclpy.node import Node

DEFAULTS = {
    **dict.fromkeys(("translation.x", "translation.y", "translation.z"), 0.0),
    **dict.fromkeys(("rotation.x", "rotation.y", "rotation.z"), 0.0),
    "rotation.w": 1.0,
    "frame_id": "",
    "child_frame_id": "",
}
"""The parameters; an argument sets the same value as its parameter, and wins."""
ABOUT = {
    "translation": "Position of the child in the parent frame (m)",
    "rotation": "Orientation of the child in the parent frame, as a quaternion",
    "frame_id": "The parent frame",
    "child_frame_id": "The child frame",
}
_readers: dict[type, Reader[float | str]] = {float: read_number, str: read_text}


def main(argv: Sequence[str] | None = None) -> int:
    """Run the process; return its exit code."""
    arguments = list(sys.argv if argv is None else argv)
    if "--help" in arguments[1:]:
        sys.stdout.write(f"usage: {USAGE}\n")
        return 0

    @contextmanager
    def application(process: NodeProcess) -> Iterator[None]:
        from rclpy.logging import get_logger
        from rclpy.utilities import remove_ros_args

        logger = get_logger("static_transform_publisher")
        given = parameters_of(remove_ros_args(arguments)[1:], logger.warning)
        process.executor.add_node(_node(given))
        yield

    return run_process(application, arguments, user_errors=(DescriptionError, ParameterValueError))


def _node(given: Mapping[str, float | str]) -> "Node":
    """Return a node that has published the transform.

    Raises:
        SettingsError: a frame is missing, both are the same, or a value is not finite.
    """
    from geometry_msgs.msg import TransformStamped
    from rclpy.node import Node
    from rclpy.parameter import Parameter
    from rclpy.qos import DurabilityPolicy, QoSProfile
    from tf2_msgs.msg import TFMessage

    from arm_node.parameters import declare

    # As in ROS: several of them run at once, and nobody names each.
    suffix = "".join(random.choices(string.ascii_letters + string.digits, k=16))
    overrides = [Parameter(name, value=value) for name, value in given.items()]
    node = Node(f"static_transform_publisher_{suffix}", parameter_overrides=overrides)
    values: dict[str, Any] = {
        name: declare(node, name, default, _readers[type(default)], ABOUT[name.partition(".")[0]])
        for name, default in DEFAULTS.items()
    }
    parent, child = values["frame_id"], values["child_frame_id"]
    if not parent or not child:
        raise SettingsError(f"--frame-id and --child-frame-id are needed; usage: {USAGE}")
    if parent == child:
        raise SettingsError(f"a frame cannot be its own parent: both are {parent!r}")
    position = [values[f"translation.{axis}"] for axis in "xyz"]
    if not all(map(math.isfinite, position)):
        raise SettingsError(f"the translation {position} is not finite")
    rotation = unit_quaternion([values[f"rotation.{axis}"] for axis in "xyzw"])

    message = TransformStamped(child_frame_id=child)
    message.header.frame_id = parent
    message.header.stamp = node.get_clock().now().to_msg()
    for target, names, numbers in (
        (message.transform.translation, "xyz", position),
        (message.transform.rotation, "xyzw", rotation),
    ):
        for name, number in zip(names, numbers, strict=True):
            setattr(target, name, number)
    latched = QoSProfile(depth=1, durability=DurabilityPolicy.TRANSIENT_LOCAL)
    node.create_publisher(TFMessage, "/tf_static", latched).publish(TFMessage(transforms=[message]))
    node.get_logger().info(
        "Spinning until stopped - publishing transform\n"
        f"translation: ({', '.join(f'{number:f}' for number in position)})\n"
        f"rotation: ({', '.join(f'{number:f}' for number in rotation)})\n"
        f"from '{parent}' to '{child}'"
    )
    return node


if __name__ == "__main__":
    sys.exit(main())
