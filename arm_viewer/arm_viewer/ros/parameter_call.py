"""The parameters of a node: read them into a form, and set those that were typed."""

from collections.abc import Generator, Mapping
from typing import Any

from rcl_interfaces.msg import Parameter, ParameterValue
from rcl_interfaces.srv import (
    DescribeParameters,
    GetParameters,
    ListParameters,
    SetParameters,
)
from rclpy.node import Node

from arm_node.messages import MessageValueError
from arm_viewer.calls.call import CallState, failure
from arm_viewer.calls.parameter_fields import VALUE_FIELDS, parameter_field, parameter_value
from arm_viewer.ros.service_call import KnownService, Report

MAX_PARAMETERS = 500
Questions = Generator[tuple[type, str, Any], Any, CallState]
"""Yields type and name of a service of the node and a request, gets the answer, and so on; returns
what comes of it. A MessageValueError is a failure."""


class ParameterCall:
    """Asks a node's parameter services one after the other."""

    def __init__(self, node: Node, name: str, report: Report, questions: Questions) -> None:
        """Begin with the first question."""
        self._node = node
        self._name = name
        self._report = report
        self._questions = questions
        self._services: list[KnownService] = []
        self._ask_next(None)
        report(CallState(f"Asking {name}"))

    def check(self, now_s: float) -> None:
        """Ask, and report that no answer comes."""
        problem = self._services[-1].ask(now_s, self._request, self._take)
        if problem:
            self._report(failure(problem))

    def cancel(self) -> None:
        """Stop waiting."""
        self._report(failure("Not waited for any longer"))

    def close(self) -> None:
        """Destroy the clients."""
        for service in self._services:
            service.close()

    def _take(self, answer: Any) -> None:
        try:
            self._ask_next(answer)
        except StopIteration as end:
            self._report(end.value)
        except MessageValueError as error:
            self._report(failure(str(error)))

    def _ask_next(self, answer: Any) -> None:
        kind, service, self._request = self._questions.send(answer)
        self._services.append(KnownService(self._node, kind, f"{self._name}/{service}"))


def parameter_form(node_name: str) -> Questions:
    """Read the parameters of a node with their values, ranges and descriptions."""
    listed = yield ListParameters, "list_parameters", ListParameters.Request()
    names = sorted(listed.result.names)[:MAX_PARAMETERS]
    request = DescribeParameters.Request(names=names)
    described = yield DescribeParameters, "describe_parameters", request
    found = yield GetParameters, "get_parameters", GetParameters.Request(names=names)
    # One that was undeclared meanwhile is missing, and then nobody knows which.
    if not len(names) == len(described.descriptors) == len(found.values):
        return failure(f"the parameters of {node_name} have changed meanwhile; try again")
    form = tuple(map(parameter_field, described.descriptors, found.values))
    return CallState("", is_over=True, form=form)


def parameter_setting(typed: Mapping[str, str]) -> Questions:
    """Set parameters of a node, each by the type that it has."""
    request = DescribeParameters.Request(names=list(typed))
    described = yield DescribeParameters, "describe_parameters", request
    kinds = {d.name: 0 if d.dynamic_typing else d.type for d in described.descriptors}
    parameters: list[Parameter] = []
    for name, text in typed.items():
        kind, content = parameter_value(kinds.get(name, 0), text, name)
        value = ParameterValue(type=kind)
        setattr(value, VALUE_FIELDS[kind], content)
        parameters.append(Parameter(name=name, value=value))
    answer = yield SetParameters, "set_parameters", SetParameters.Request(parameters=parameters)
    refused = [
        f"{name}: {result.reason or 'refused'}"
        for name, result in zip(typed, answer.results, strict=False)
        if not result.successful
    ]
    text = "; ".join(refused) or f"Set {len(typed)} of {len(typed)}"
    return CallState(text, is_over=True, is_failed=bool(refused))
