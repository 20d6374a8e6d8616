"""The parameters of a node: read them into a form, and set those that were typed."""

from collections.abc import Callable, Mapping
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
Step = Callable[[float], str]


class _ParameterCall:
    """Asks a node's parameter services one after the other."""

    def __init__(self, node: Node, name: str, report: Report, first: Step) -> None:
        self._node = node
        self._name = name
        self._report = report
        self._step = first
        self._services: dict[str, KnownService] = {}
        report(CallState(f"Asking {name}"))

    def check(self, now_s: float) -> None:
        """Ask, and report that no answer comes."""
        problem = self._step(now_s)
        if problem:
            self._report(failure(problem))

    def cancel(self) -> None:
        """Stop waiting."""
        self._report(failure("Not waited for any longer"))

    def close(self) -> None:
        """Destroy the clients."""
        for service in self._services.values():
            service.close()

    def ask(self, now_s: float, class_: Any, name: str, request: Any, then: Any) -> str:
        """Ask one of the node's services; see `KnownService.ask`."""
        if name not in self._services:
            self._services[name] = KnownService(self._node, class_, f"{self._name}/{name}")
        return self._services[name].ask(now_s, request, then)


class ParameterForm(_ParameterCall):
    """Reads the parameters of a node with their values, ranges and descriptions."""

    def __init__(self, node: Node, name: str, report: Report) -> None:
        """Ask for the names first."""
        super().__init__(node, name, report, self._list)
        self._names: list[str] = []
        self._descriptors: list[Any] = []

    def _list(self, now_s: float) -> str:
        request = ListParameters.Request()
        return self.ask(now_s, ListParameters, "list_parameters", request, self._take_names)

    def _take_names(self, response: Any) -> None:
        self._names = sorted(response.result.names)[:MAX_PARAMETERS]
        self._step = self._describe

    def _describe(self, now_s: float) -> str:
        request = DescribeParameters.Request(names=self._names)
        return self.ask(
            now_s, DescribeParameters, "describe_parameters", request, self._take_descriptors
        )

    def _take_descriptors(self, response: Any) -> None:
        self._descriptors = list(response.descriptors)
        self._step = self._get

    def _get(self, now_s: float) -> str:
        request = GetParameters.Request(names=self._names)
        return self.ask(now_s, GetParameters, "get_parameters", request, self._take_values)

    def _take_values(self, response: Any) -> None:
        # One that was undeclared meanwhile is missing, and then nobody knows which.
        values = list(response.values)
        if not len(self._names) == len(self._descriptors) == len(values):
            changed = f"the parameters of {self._name} have changed meanwhile; try again"
            self._report(failure(changed))
            return
        form = tuple(map(parameter_field, self._descriptors, values))
        self._report(CallState("", is_over=True, form=form))


class ParameterSetting(_ParameterCall):
    """Sets parameters of a node."""

    def __init__(self, node: Node, name: str, typed: Mapping[str, str], report: Report) -> None:
        """Ask for the types first."""
        super().__init__(node, name, report, self._describe)
        self._typed = typed
        self._parameters: list[Parameter] = []

    def _describe(self, now_s: float) -> str:
        request = DescribeParameters.Request(names=list(self._typed))
        return self.ask(
            now_s, DescribeParameters, "describe_parameters", request, self._take_descriptors
        )

    def _take_descriptors(self, response: Any) -> None:
        kinds = {d.name: 0 if d.dynamic_typing else d.type for d in response.descriptors}
        try:
            for name, text in self._typed.items():
                kind, content = parameter_value(kinds.get(name, 0), text, name)
                value = ParameterValue(type=kind)
                setattr(value, VALUE_FIELDS[kind], content)
                self._parameters.append(Parameter(name=name, value=value))
        except MessageValueError as error:
            self._report(failure(str(error)))
            return
        self._step = self._set

    def _set(self, now_s: float) -> str:
        request = SetParameters.Request(parameters=self._parameters)
        return self.ask(now_s, SetParameters, "set_parameters", request, self._take_results)

    def _take_results(self, response: Any) -> None:
        refused = [
            f"{name}: {result.reason or 'refused'}"
            for name, result in zip(self._typed, response.results, strict=False)
            if not result.successful
        ]
        done = len(self._typed) - len(refused)
        text = "; ".join(refused) or f"Set {done} of {len(self._typed)}"
        self._report(CallState(text, is_over=True, is_failed=bool(refused)))
