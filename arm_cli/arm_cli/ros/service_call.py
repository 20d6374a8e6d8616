"""Calls of services, and how long to wait for them."""

from typing import Any

from rclpy.client import Client

from arm_cli.errors import UnansweredError
from arm_cli.ros.session import Session

SERVER_TIMEOUT_S = 10.0
ANSWER_TIMEOUT_S = 30.0


def call_service(
    session: Session,
    service_class: Any,
    name: str,
    request: Any,
    server_timeout_s: float | None = SERVER_TIMEOUT_S,
    answer_timeout_s: float = ANSWER_TIMEOUT_S,
) -> Any:
    """Call a service of a node of the suite, or one that is like it; return the answer.

    Raises:
        UnansweredError: nobody offers it, or nobody answers.
    """
    client = session.node.create_client(service_class, session.full_name(name))
    try:
        wait_for_server(session, client, server_timeout_s)
        answer = session.result(client.call_async(request), answer_timeout_s)
    finally:
        session.node.destroy_client(client)
    if answer is None:
        raise UnansweredError(f"no answer from {name} within {answer_timeout_s:g} s")
    return answer


def wait_for_server(session: Session, client: Client, timeout_s: float | None) -> None:
    """Wait until a service is offered.

    Raises:
        UnansweredError: it is not, within the time-out.
    """
    name = client.srv_name
    there = session.wait_until(
        client.service_is_ready, lambda: f"waiting for service {name}", timeout_s
    )
    if not there:
        raise UnansweredError(f"nobody offers the service {name} (waited {timeout_s:g} s)")
