"""Calls services and waits for their answers."""

from typing import Any

from rclpy.client import Client

from arm_cli.errors import UnansweredError
from arm_cli.ros.session import CommandSession

SERVER_TIMEOUT_S = 10.0
ANSWER_TIMEOUT_S = 30.0


def call_service(
    session: CommandSession,
    service_class: Any,
    name: str,
    request: Any,
    server_timeout_s: float | None = SERVER_TIMEOUT_S,
    answer_timeout_s: float | None = ANSWER_TIMEOUT_S,
) -> Any:
    """Call a service and return its answer.

    An answer timeout of None waits as long as the service has a server.

    Raises:
        UnansweredError: the service has no server, or the server does not answer, or ends first.
    """
    client = session.node.create_client(service_class, session.full_name(name))
    try:
        wait_for_server(session, client, server_timeout_s)
        future = client.call_async(request)
        answer = session.answer(future, name, client.service_is_ready, answer_timeout_s)
    finally:
        session.node.destroy_client(client)
    if answer is None:
        raise UnansweredError(f"no answer from {name} within {answer_timeout_s:g} s")
    return answer


def wait_for_server(session: CommandSession, client: Client, timeout_s: float | None) -> None:
    """Wait until a service has a server.

    Raises:
        UnansweredError: there is no server before the timeout.
    """
    name = client.srv_name
    there = session.wait_until(
        client.service_is_ready, lambda: f"waiting for service {name}", timeout_s
    )
    if not there:
        raise UnansweredError(f"service {name} has no server (waited {timeout_s:g} s)")
