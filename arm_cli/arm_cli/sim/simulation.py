"""The simulation that a verb asks, by the services of simulation_interfaces."""

import argparse
from collections.abc import Iterator
from contextlib import contextmanager
from typing import TYPE_CHECKING, Any

from arm_cli.errors import RefusedError
from arm_cli.names import absolute_name
from arm_cli.ros.connection import connect

if TYPE_CHECKING:
    from arm_cli.ros.session import Session

RESULT_OK = 1
STOPPED, PLAYING, PAUSED, QUITTING, NO_WORLD, LOADING_WORLD = range(6)
"""The states of SimulationState."""
STATE_NAMES = ("stopped", "playing", "paused", "quitting", "no world", "loading a world")


def add_namespace_argument(parser: argparse.ArgumentParser) -> None:
    """Add the choice of the simulation."""
    parser.add_argument(
        "-n", "--namespace", default="/", metavar="NS", help="of the simulation's services"
    )


class SimulationClient:
    """Asks one simulation. Every method raises UnansweredError where it does not answer."""

    def __init__(self, session: "Session", namespace: str) -> None:
        """Ask the simulation whose services are in a namespace."""
        self.session = session
        self._namespace = absolute_name(namespace).rstrip("/")

    def ask(self, type_: str, service: str, **fields: Any) -> Any:
        """Call a service of simulation_interfaces; return the answer.

        Args:
            type_: such as "GetEntities".
            service: such as "get_entities".
            fields: of the request.

        Raises:
            RefusedError: the answer is that it cannot be done.
        """
        import simulation_interfaces.srv as services

        from arm_cli.ros.service_call import call_service

        class_ = getattr(services, type_)
        request = class_.Request(**fields)
        answer = call_service(self.session, class_, f"{self._namespace}/{service}", request)
        result = getattr(answer, "result", None)
        if result is not None and result.result != RESULT_OK:
            raise RefusedError(f"{result.error_message or 'refused'} (result {result.result})")
        return answer

    def go_to(self, state: int) -> None:
        """Change the simulation's state, to one of the numbers above."""
        from simulation_interfaces.msg import SimulationState

        self.ask("SetSimulationState", "set_simulation_state", state=SimulationState(state=state))


@contextmanager
def ask_simulation(options: argparse.Namespace) -> Iterator[SimulationClient]:
    """Give a client of the simulation's services."""
    with connect() as session:
        yield SimulationClient(session, options.namespace)
