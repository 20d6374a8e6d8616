"""Calls of whatever the graph offers: services, actions, topics and parameters, by their types."""

import time
from collections.abc import Callable, Mapping
from importlib import import_module
from types import MappingProxyType
from typing import Any, Protocol

from rclpy._rclpy_pybind11 import RCLError
from rclpy.node import Node

from arm_node.messages import MessageValueError
from arm_viewer.calls.call import (
    Callee,
    CallKind,
    CallRequest,
    CallState,
    EndCall,
    OpenForm,
    PlaceCall,
    failure,
)
from arm_viewer.calls.form import form_of, read_form
from arm_viewer.ros.goal_call import GoalCall
from arm_viewer.ros.observer import Observer, TopicTypes, used_types
from arm_viewer.ros.parameter_call import ParameterCall, parameter_form, parameter_setting
from arm_viewer.ros.publication import Publication
from arm_viewer.ros.service_call import ServiceCall

MAX_CALLS = 32
"""Most calls at a time."""
KEPT_CALLS = 64
"""Calls whose end is remembered, until the page has shown it."""
_SEND_GOAL, _GOAL_TYPE = "/_action/send_goal", "_SendGoal"
_LIST_PARAMETERS = "/list_parameters"
_OF_EVERY_NODE = (
    *("/describe_parameters", "/get_parameter_types", "/get_parameters", _LIST_PARAMETERS),
    *("/set_parameters", "/set_parameters_atomically", "/get_type_description"),
)


class OngoingCall(Protocol):
    """A call that goes on; used in the executor's thread."""

    def check(self, now_s: float) -> None:
        """Report what has changed; called 30 times a second."""
        ...

    def cancel(self) -> None:
        """End it, and report the end as soon as it is known."""
        ...

    def close(self) -> None:
        """Destroy its end points."""
        ...


class CallDesk(Observer):
    """Lists what can be called, and places the calls.

    Attributes:
        callees: what can be called, sorted.
        states: what has become of each call, by its number.
    """

    def __init__(self, node: Node) -> None:
        """Start without calls."""
        self._node = node
        self._calls: dict[int, OngoingCall] = {}
        self.callees: tuple[Callee, ...] = ()
        self.states: Mapping[int, CallState] = MappingProxyType({})

    def discover(self, topics: TopicTypes) -> None:
        """List what can be called."""
        # This node cannot have end points of two types on a topic.
        used = used_types(self._node)
        found = [
            Callee(CallKind.TOPIC, name, used.get(name, types[0]))
            for name, types in topics.items()
            if types and "/_" not in name
        ]
        for name, types in self._node.get_service_names_and_types():
            # The graph also lists services that only have clients.
            if self._node.count_services(name):
                found += _callees(name, types[0])
        found.sort(key=lambda callee: (callee.name, callee.kind.value))
        self.callees = tuple(found)

    def collect(self, now_s: float) -> None:
        """Let the calls report what has changed."""
        for number, call in tuple(self._calls.items()):
            call.check(now_s)
            if self.states[number].is_over:
                self._calls.pop(number).close()

    def serve(self, request: CallRequest) -> None:
        """Begin or end a call."""
        number = request.number
        if isinstance(request, EndCall):
            if number in self._calls:
                self._calls[number].cancel()
            return
        if len(self._calls) >= MAX_CALLS:
            self._report(number, failure(f"{MAX_CALLS} calls are under way; end one of them first"))
            return
        try:
            self._begin(request)
        except (MessageValueError, RCLError) as error:
            self._report(number, failure(str(error)))

    def _begin(self, request: OpenForm | PlaceCall) -> None:
        number, callee = request.number, request.callee

        def report(state: CallState) -> None:
            self._report(number, state)

        if callee.kind is CallKind.PARAMETERS:
            questions = (
                parameter_form(callee.name)
                if isinstance(request, OpenForm)
                else parameter_setting(request.typed)
            )
            call = ParameterCall(self._node, callee.name, report, questions)
        else:
            class_ = interface_class(callee)
            message = _REQUESTS[callee.kind](class_)
            if isinstance(request, OpenForm):
                report(CallState("", is_over=True, form=form_of(message)))
                return
            filled = read_form(message, request.typed)
            if callee.kind is CallKind.SERVICE:
                call = ServiceCall(self._node, class_, callee.name, filled, report)
            elif callee.kind is CallKind.ACTION:
                call = GoalCall(self._node, class_, callee.name, filled, report)
            else:
                call = Publication(self._node, class_, callee.name, filled, request.rate_hz, report)
        self._calls[number] = call
        call.check(time.monotonic())

    def _report(self, number: int, state: CallState) -> None:
        if self.states.get(number) == state:
            return
        states = {**self.states, number: state}
        over = [n for n, kept in states.items() if kept.is_over]
        for old in over[: max(len(states) - KEPT_CALLS, 0)]:
            del states[old]
        self.states = MappingProxyType(states)


_REQUESTS: Mapping[CallKind, Callable[[Any], Any]] = MappingProxyType(
    {
        CallKind.SERVICE: lambda class_: class_.Request(),
        CallKind.ACTION: lambda class_: class_.Goal(),
        CallKind.TOPIC: lambda class_: class_(),
    }
)


def interface_class(callee: Callee) -> Any:
    """Return the class of a callee's type.

    Raises:
        MessageValueError: its package is not installed here.
    """
    package, _, name = callee.type.partition("/")
    module, _, name = name.rpartition("/")
    try:
        return getattr(import_module(f"{package}.{module}"), name)
    except (ImportError, AttributeError, ValueError) as error:
        raise MessageValueError(
            f"{callee.name} has the type {callee.type}, which cannot be used here: {error}; "
            f"install the package {package} beside the page"
        ) from None


def _callees(service: str, type_: str) -> list[Callee]:
    """Return what a service stands for: itself, an action, or the parameters of a node."""
    if service.endswith(_SEND_GOAL):
        name, action = service.removesuffix(_SEND_GOAL), type_.removesuffix(_GOAL_TYPE)
        return [Callee(CallKind.ACTION, name, action)]
    if service.endswith(_LIST_PARAMETERS):
        return [Callee(CallKind.PARAMETERS, service.removesuffix(_LIST_PARAMETERS), "")]
    if "/_" in service or service.endswith(_OF_EVERY_NODE):
        return []
    return [Callee(CallKind.SERVICE, service, type_)]
