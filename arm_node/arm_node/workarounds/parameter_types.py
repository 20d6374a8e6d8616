"""Answers requests to set a parameter of a type that does not exist.

rclpy raises an exception on such a request, so the client never gets an answer. This refuses the
parameter with a reason. Made for rclpy 7.1 and 9.1; no upstream issue is known. If this is switched
off, the client waits for ever.
"""

from collections.abc import Callable
from typing import Any

from rcl_interfaces.msg import Parameter as ParameterMessage
from rcl_interfaces.msg import SetParametersResult
from rclpy.parameter import Parameter
from rclpy.parameter_service import ParameterService

from arm_node.printable import printable
from arm_node.workarounds.switch import is_on

_TYPES = frozenset(type_.value for type_ in Parameter.Type)
_CALLBACKS = {"_set_parameters_callback": False, "_set_parameters_atomically_callback": True}
"""The methods of rclpy that fail, and whether they set all parameters or none."""


def refuse_unknown_parameter_types() -> None:
    """Make the parameter services of all nodes created from now on refuse unknown types."""
    if not is_on("parameter_types"):
        return
    for name, as_one in _CALLBACKS.items():
        callback = getattr(ParameterService, name, None)
        if callback is not None and not hasattr(callback, "refuses_unknown_types"):
            guarded = _atomically(callback) if as_one else _one_by_one(callback)
            guarded.refuses_unknown_types = True  # pyright: ignore[reportFunctionMemberAccess]
            setattr(ParameterService, name, guarded)


def _one_by_one(callback: Callable[..., Any]) -> Callable[..., Any]:
    def guarded(self: ParameterService, request: Any, response: Any) -> Any:
        for parameter in request.parameters:
            refusal = _refusal(parameter)
            if refusal is None:
                response = callback(self, type(request)(parameters=[parameter]), response)
            else:
                response.results.append(refusal)
        return response

    return guarded


def _atomically(callback: Callable[..., Any]) -> Callable[..., Any]:
    def guarded(self: ParameterService, request: Any, response: Any) -> Any:
        refusal = next(filter(None, map(_refusal, request.parameters)), None)
        if refusal is None:
            return callback(self, request, response)
        response.result = refusal
        return response

    return guarded


def _refusal(parameter: ParameterMessage) -> SetParametersResult | None:
    if parameter.value.type in _TYPES:
        return None
    reason = f"parameter {printable(repr(parameter.name))} has type {parameter.value.type}; "
    return SetParametersResult(successful=False, reason=f"{reason}the types are 0 to {max(_TYPES)}")
