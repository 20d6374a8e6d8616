"""`arm stop`: engages the emergency stop of every robot, or releases it."""

import argparse
from typing import TYPE_CHECKING, Any

from arm_cli.arguments import Argument, Flag, verb
from arm_cli.errors import UnansweredError
from arm_cli.names import absolute_name
from arm_cli.output import complain, say
from arm_cli.ros.connection import connect

if TYPE_CHECKING:
    from arm_cli.ros.session import CommandSession

SERVICE = "/emergency_stop"
TYPE = "std_srvs/srv/SetBool"
SERVER_TIMEOUT_S = 10.0
OTHERS_S = 0.5
"""How long to look for more robots after the first one has been found."""
ANSWER_TIMEOUT_S = 10.0


@verb(
    Flag("--release", help="release the stop; controllers continue from rest"),
    Argument(
        "-n",
        "--namespace",
        metavar="NS",
        help="only the robot whose controller manager is in this namespace (default: all robots)",
    ),
)
def stop(options: argparse.Namespace) -> None:
    """Stop or release the robots, and print what each service answers."""
    with connect() as session:
        robots = EmergencyStop(session, engaged=not options.release)
        if options.namespace is not None:
            robots.call(f"{absolute_name(options.namespace).rstrip('/')}{SERVICE}")
        else:
            robots.call_all()


class EmergencyStop:
    """Calls the services of one kind: those that stop, or those that release."""

    def __init__(self, session: "CommandSession", *, engaged: bool) -> None:
        self._session = session
        self._engaged = engaged

    def call_all(self) -> None:
        """Call each service as soon as it is found; the first robot does not wait for others."""
        session = self._session
        done: list[str] = []
        failures: list[str] = []
        if not session.wait_until(
            lambda: bool(self._found()),
            lambda: "waiting for a robot with an emergency stop",
            SERVER_TIMEOUT_S,
        ):
            raise UnansweredError(
                f"there is no robot: no service {SERVICE} (waited {SERVER_TIMEOUT_S:g} s)"
            )
        while True:
            for service in (name for name in self._found() if name not in done):
                done.append(service)
                try:
                    self.call(service)
                except UnansweredError as error:
                    failures.append(str(error))
            if not session.wait_until(
                lambda: any(name not in done for name in self._found()), timeout_s=OTHERS_S
            ):
                break
        for failure in failures[:-1]:
            complain(f"arm stop: {failure}")
        if failures:
            raise UnansweredError(failures[-1])

    def call(self, service: str) -> None:
        """Call one service and print its answer.

        Raises:
            UnansweredError: it does not answer, or does not succeed.
        """
        from std_srvs.srv import SetBool

        from arm_cli.ros.service_call import call_service

        answer: Any = call_service(
            self._session,
            SetBool,
            service,
            SetBool.Request(data=self._engaged),
            SERVER_TIMEOUT_S,
            ANSWER_TIMEOUT_S,
        )
        if not answer.success:
            raise UnansweredError(f"{service}: {answer.message or 'refused'}")
        say(f"{service}: {answer.message}")

    def _found(self) -> list[str]:
        """Return the services that are discovered; the one of all robots comes first."""
        services = self._session.node.get_service_names_and_types()
        found = [
            name
            for name, types in services
            if name.endswith(SERVICE) and TYPE in types and self._session.node.count_services(name)
        ]
        return sorted(found, key=len)
