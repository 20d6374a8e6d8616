"""A client of a simulation's simulation_interfaces services, for the verbs of `arm sim`."""

from collections.abc import Iterator
from contextlib import contextmanager
from typing import TYPE_CHECKING, Any

from arm_cli.arguments import Argument
from arm_cli.errors import NoSuchNameError, SimulationRefusedError
from arm_cli.names import absolute_name, this_domain
from arm_cli.ros.connection import connect

if TYPE_CHECKING:
    from arm_cli.ros.parameters import NodeParameters
    from arm_cli.ros.session import CommandSession

NODE = "arm_gazebo"
"""The node with the simulation's parameters."""
SERVING_NODE = "simulation"
"""The node that serves its figures."""
STATE_SERVICE = "get_simulation_state"
"""Each simulation has this service."""
GONE_S = 0.5
"""A simulation that was there and is not seen for so long has ended."""
RESULT_OK = 1
PLAYING, PAUSED = 1, 2
"""States of SimulationState."""
STATE_NAMES = ("stopped", "playing", "paused", "quitting", "no world", "loading a world")


NAMESPACE = Argument(
    "-n", "--namespace", default="/", metavar="NS", help="namespace of the simulation's services"
)


class SimulationClient:
    """Calls one simulation's services. Every method may raise UnansweredError."""

    def __init__(self, session: "CommandSession", namespace: str) -> None:
        """Call the services in a namespace."""
        self.session = session
        self._namespace = absolute_name(namespace).rstrip("/")

    def ask(
        self,
        type_: str,
        service: str,
        *,
        patiently: bool = False,
        **fields: Any,
    ) -> Any:
        """Call a service of a type in simulation_interfaces.srv; return the answer.

        With `patiently` it waits for the answer as long as the simulation is there.

        Raises:
            SimulationRefusedError: the simulation refuses the request.
        """
        import simulation_interfaces.srv as services

        from arm_cli.ros.service_call import ANSWER_TIMEOUT_S, call_service

        class_ = getattr(services, type_)
        request = class_.Request(**fields)
        answer = call_service(
            self.session,
            class_,
            f"{self._namespace}/{service}",
            request,
            answer_timeout_s=None if patiently else ANSWER_TIMEOUT_S,
        )
        result = getattr(answer, "result", None)
        if result is not None and result.result != RESULT_OK:
            raise SimulationRefusedError(
                f"{result.error_message or 'refused'} (result {result.result})"
            )
        return answer

    def set_state(self, state: int) -> None:
        """Set the simulation's state, one of the constants above."""
        from simulation_interfaces.msg import SimulationState

        self.ask("SetSimulationState", "set_simulation_state", state=SimulationState(state=state))

    def statistics(self) -> dict[str, dict[str, str]]:
        """Return the figures of the run: by part, such as "tick", then by name."""
        from diagnostic_msgs.srv import SelfTest

        from arm_cli.ros.service_call import call_service

        service = f"{self._namespace}/{SERVING_NODE}/get_statistics"
        answer = call_service(self.session, SelfTest, service, SelfTest.Request())
        if answer.passed != b"\x01":
            raise SimulationRefusedError("; ".join(status.message for status in answer.status))
        return {
            status.name: {pair.key: pair.value for pair in status.values}
            for status in answer.status
        }

    def set_parameter(self, name: str, content: float | str, *, if_there: bool = False) -> None:
        """Set a parameter of the simulation's node.

        With `if_there` it waits only as long as the simulation, found before, is there.

        Raises:
            SimulationRefusedError: the simulation refuses the value.
        """
        from rcl_interfaces.msg import ParameterValue

        from arm_cli.ros.parameters import set_value

        value = ParameterValue()
        set_value(value, content)
        result = self.parameters(if_there).set({name: value})[0]
        if not result.successful:
            raise SimulationRefusedError(result.reason)

    def parameters(self, if_there: bool = False) -> "NodeParameters":
        """Return the parameters of the simulation's node; see `set_parameter`."""
        from arm_cli.ros.graph import NodeName
        from arm_cli.ros.parameters import NodeParameters

        node = NodeName(self._namespace or "/", NODE)
        if not if_there:
            return NodeParameters(self.session, node)
        return NodeParameters(self.session, node, answer_timeout_s=None, server_timeout_s=GONE_S)


@contextmanager
def ask_simulation(namespace: str = "/", *, must_run: bool = False) -> Iterator[SimulationClient]:
    """Yield a client of the simulation's services in a namespace.

    With `must_run` it gives up as soon as discovery finds no simulation, instead of waiting for one
    that is starting.

    Raises:
        NoSuchNameError: no simulation is found.
    """
    with connect() as session:
        if must_run:
            _find_simulation(session, namespace)
        yield SimulationClient(session, namespace)


def _find_simulation(session: "CommandSession", namespace: str) -> None:
    from arm_cli.ros.graph import Graph

    graph = Graph(session)
    try:
        graph.find_service(f"{absolute_name(namespace).rstrip('/')}/{STATE_SERVICE}")
    except NoSuchNameError as error:
        others = [
            name.removesuffix(STATE_SERVICE).rstrip("/") or "/"
            for name in graph.services()
            if name.endswith(f"/{STATE_SERVICE}")
        ]
        advice = (
            f"there is one in -n {' or '.join(others)}" if others else "start one with arm launch"
        )
        where = "" if namespace == "/" else f" in {namespace}"
        raise NoSuchNameError(f"no simulation runs{where} on {this_domain()}; {advice}") from error
