"""A client of a controller manager for commands."""

from collections.abc import Callable
from typing import Any

from arm_cli.errors import UnansweredError
from arm_cli.output import complain
from arm_cli.ros.service_call import ANSWER_TIMEOUT_S, SERVER_TIMEOUT_S, call_service
from arm_cli.ros.session import CommandSession
from arm_node.controller_manager import SERVICES, ControllerManagerClient

MARK = "/list_controllers"
"""Every controller manager has this service, with the type MARK_TYPE."""
MARK_TYPE = "controller_manager_msgs/srv/ListControllers"
OTHERS_S = 0.5
"""How long to wait for the requested manager after another one has been discovered."""


class _SessionCaller:
    """A `ServiceTransport` that sends each request once, from a session's node."""

    def __init__(
        self,
        session: CommandSession,
        manager: str,
        answer_timeout_s: float,
        or_the_only_one: bool = False,
    ) -> None:
        """Call the services of the manager whose node has this absolute name.

        With `or_the_only_one` it calls another manager if that is the only one on the graph.
        """
        self._session = session
        self._manager = manager
        self._answer_timeout_s = answer_timeout_s
        self._may_choose = or_the_only_one

    def query(self, service: str, request: Any) -> Any:
        """Return the answer.

        Raises:
            UnansweredError: the service has no server, or the server does not answer.
        """
        if self._may_choose:
            self._manager = self._existing(service)
            self._may_choose = False
        name = f"{self._manager}/{service}"
        return call_service(
            self._session,
            SERVICES[service],
            name,
            request,
            answer_timeout_s=self._answer_timeout_s,
        )

    def _existing(self, service: str) -> str:
        """Return the requested manager, or else the only one on the graph.

        Raises:
            UnansweredError: there is no manager, or there are several others.
        """
        wanted, name = self._manager, f"{self._manager}/{service}"
        if not self._session.wait_until(
            lambda: bool(manager_names(self._session)),
            lambda: f"waiting for service {name}",
            SERVER_TIMEOUT_S,
        ):
            raise UnansweredError(f"service {name} has no server (waited {SERVER_TIMEOUT_S:g} s)")
        self._session.wait_until(lambda: wanted in manager_names(self._session), timeout_s=OTHERS_S)
        found = manager_names(self._session)
        if wanted in found:
            return wanted
        if len(found) > 1:
            raise UnansweredError(
                f"there is no {wanted}, but there are {', '.join(found)}: choose one with -c"
            )
        complain(f"there is no {wanted}: asking {found[0]}")
        return found[0]

    def change(self, service: str, request: Any, is_done: Callable[[], bool]) -> Any:
        """Return the answer; errors as `query`."""
        return self.query(service, request)


def manager_names(session: CommandSession) -> list[str]:
    """Return the absolute names of the controller managers that are discovered, sorted."""
    services = session.node.get_service_names_and_types()
    return sorted(
        name.removesuffix(MARK)
        for name, types in services
        if name.endswith(MARK) and MARK_TYPE in types
    )


def manager_client(
    session: CommandSession,
    manager: str,
    answer_timeout_s: float = ANSWER_TIMEOUT_S,
    or_the_only_one: bool = False,
) -> ControllerManagerClient:
    """Return a client of the manager whose node has this absolute name.

    With `or_the_only_one` it uses another manager if that is the only one on the graph. The
    client's methods raise UnansweredError if the manager does not answer.
    """
    return ControllerManagerClient(
        _SessionCaller(session, manager, answer_timeout_s, or_the_only_one)
    )
