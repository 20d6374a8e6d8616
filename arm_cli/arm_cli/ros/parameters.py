"""The parameter services of a node."""

from collections.abc import Mapping, Sequence
from typing import Any

from rcl_interfaces.msg import Parameter, ParameterDescriptor, ParameterValue
from rcl_interfaces.srv import (
    DescribeParameters,
    GetParameters,
    ListParameters,
    SetParameters,
)

from arm_cli.errors import NoSuchNameError
from arm_cli.ros.graph import NodeName
from arm_cli.ros.service_call import ANSWER_TIMEOUT_S, SERVER_TIMEOUT_S, call_service
from arm_cli.ros.session import CommandSession
from arm_node.names import describe_known


class NodeParameters:
    """Calls one node's parameter services. Every method may raise UnansweredError."""

    def __init__(
        self,
        session: CommandSession,
        node: NodeName,
        answer_timeout_s: float = ANSWER_TIMEOUT_S,
        server_timeout_s: float = SERVER_TIMEOUT_S,
    ) -> None:
        """Call the services of a node, from a session's node."""
        self._session = session
        self._node = node
        self._server_timeout_s = server_timeout_s
        self._answer_timeout_s = answer_timeout_s

    def names(self, prefixes: Sequence[str] = ()) -> list[str]:
        """Return the names of its parameters, sorted."""
        request = ListParameters.Request(prefixes=list(prefixes))
        return sorted(self._call(ListParameters, "list_parameters", request).result.names)

    def values(self, names: Sequence[str]) -> list[ParameterValue]:
        """Return the values of parameters in their order; undeclared parameters are missing."""
        request = GetParameters.Request(names=list(names))
        return list(self._call(GetParameters, "get_parameters", request).values)

    def value(self, name: str) -> ParameterValue:
        """Return the value of one parameter.

        Raises:
            NoSuchNameError: the node has no such parameter; the message suggests similar names.
        """
        values = self.values([name])
        if values and values[0].type:
            return values[0]
        self.check_known(name)
        return values[0] if values else ParameterValue()

    def descriptors(self, names: Sequence[str]) -> list[ParameterDescriptor]:
        """Return the descriptors of parameters."""
        request = DescribeParameters.Request(names=list(names))
        return list(self._call(DescribeParameters, "describe_parameters", request).descriptors)

    def set(self, values: Mapping[str, ParameterValue]) -> list[Any]:
        """Set parameters one by one; return a SetParametersResult for each."""
        parameters = [Parameter(name=name, value=value) for name, value in values.items()]
        request = SetParameters.Request(parameters=parameters)
        return list(self._call(SetParameters, "set_parameters", request).results)

    def check_known(self, *names: str) -> None:
        """Check that the node has parameters.

        Raises:
            NoSuchNameError: it lacks a parameter; the message suggests similar names.
        """
        known = self.names()
        for name in names:
            if name not in known:
                hint = describe_known(name, known, "it has")
                raise NoSuchNameError(f"{self._node.full_name} has no parameter {name!r}; {hint}")

    def _call(self, service_class: Any, service: str, request: Any) -> Any:
        name = f"{self._node.full_name}/{service}"
        return call_service(
            self._session,
            service_class,
            name,
            request,
            self._server_timeout_s,
            self._answer_timeout_s,
        )
