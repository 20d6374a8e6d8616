"""What rclpy raises where a node's parameters or arguments are wrong, as sentences."""

from collections.abc import Iterator
from contextlib import contextmanager

from rclpy.exceptions import NameValidationException, ParameterException

from arm_description.errors import SettingsError
from arm_node.process import first_line


@contextmanager
def user_mistakes_named() -> Iterator[None]:
    """Turn what the making of a node raises for bad arguments into a SettingsError.

    A parameter of another type, a QoS override that does not exist, a name that ROS refuses;
    rcl's own refusals come as RuntimeError.
    """
    try:
        yield
    except (ParameterException, NameValidationException, RuntimeError) as error:
        raise SettingsError(f"cannot make the node: {first_line(error)}") from error
