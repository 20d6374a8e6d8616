"""Parameters of the simulation's node that take effect while it runs."""

from collections.abc import Callable, Sequence

from rcl_interfaces.msg import SetParametersResult
from rclpy.node import Node
from rclpy.parameter import Parameter

from arm_node.parameter_values import ParameterValueError, Reader, Value, read_parameter


def follow_parameter(
    node: Node, name: str, read: Reader[Value], apply: Callable[[Value], object]
) -> None:
    """Apply a declared parameter each time a client sets it.

    Args:
        node: the node that declares it.
        name: its name.
        read: converts the value; a value that it refuses is not set, and the client gets the
            reason.
        apply: takes the new value; on the thread of the node's executor.
    """

    def check(changed: Sequence[Parameter]) -> SetParametersResult:
        try:
            for parameter in changed:
                if parameter.name == name:
                    read_parameter(name, parameter.value, read)
        except ParameterValueError as error:
            return SetParametersResult(successful=False, reason=str(error))
        return SetParametersResult(successful=True)

    def take(changed: Sequence[Parameter]) -> None:
        for parameter in changed:
            if parameter.name == name:
                apply(read(parameter.value))

    node.add_on_set_parameters_callback(check)
    node.add_post_set_parameters_callback(take)
