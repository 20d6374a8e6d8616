"""Parameters of the simulation's node that take effect while it runs."""

from collections.abc import Callable, Sequence
from typing import Any

from rcl_interfaces.msg import SetParametersResult
from rclpy.node import Node
from rclpy.parameter import Parameter

from arm_node.parameter_values import ParameterValueError, read_parameter
from arm_node.setting import Setting


def follow_setting(node: Node, setting: Setting, apply: Callable[[Any], object]) -> None:
    """Apply a setting each time a client sets its parameter.

    Args:
        node: the node that declares it.
        setting: checks and converts the value; a value that it refuses is not set, and the client
            gets the reason.
        apply: takes the new value; on the thread of the node's executor.
    """

    def check(changed: Sequence[Parameter]) -> SetParametersResult:
        try:
            for parameter in changed:
                if parameter.name == setting.name:
                    read_parameter(setting.name, parameter.value, setting.read)
        except ParameterValueError as error:
            return SetParametersResult(successful=False, reason=str(error))
        return SetParametersResult(successful=True)

    def take(changed: Sequence[Parameter]) -> None:
        for parameter in changed:
            if parameter.name == setting.name:
                apply(setting.adapt(setting.read(parameter.value)))

    node.add_on_set_parameters_callback(check)
    node.add_post_set_parameters_callback(take)
