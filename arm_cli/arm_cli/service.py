"""`arm service call`, which prints a service's answer, and `echo`, which prints all of them."""

import argparse
import sys
import time
from typing import TYPE_CHECKING, Any

from arm_cli.arguments import JSON, Argument, Flag, positive_number, verb
from arm_cli.errors import UnansweredError
from arm_cli.interface_types import InterfaceIndex, load_class
from arm_cli.output import complain, print_json, say_document
from arm_cli.ros import completers
from arm_cli.ros.connection import connect

if TYPE_CHECKING:
    from arm_cli.ros.session import CommandSession


@verb(
    Argument(
        "service_name",
        help="such as /controller_manager/list_controllers",
        completer=completers.services,
    ),
    Argument("service_type", help="such as std_srvs/srv/Trigger"),
    Argument(
        "values", nargs="?", default="", help="fields of the request as YAML, such as '{a: 1}'"
    ),
    Flag("--stdin", help="read the values from stdin"),
    Argument(
        "-r", "--rate", type=positive_number, metavar="HZ", help="call repeatedly at this rate"
    ),
    Argument(
        "--timeout",
        type=positive_number,
        metavar="SECONDS",
        help="how long to wait for the service, and then for its answer",
    ),
    JSON,
)
def call(options: argparse.Namespace) -> None:
    """Call the service and print its answer."""
    type_ = InterfaceIndex().find(options.service_type, ("srv",))
    from arm_node.messages.filling import fill_message, read_yaml

    class_ = load_class(type_)
    text = sys.stdin.read() if options.stdin else options.values
    filled = fill_message(class_.Request(), read_yaml(text, f"{type_.full_name} request"))
    for note in filled.notes:
        complain(f"arm service call: {note}")
    with connect() as session:
        from arm_cli.ros.graph import Graph

        client = session.node.create_client(class_, session.full_name(options.service_name))
        Graph(session).wait_for_server(
            "service", client.srv_name, type_.full_name, client.service_is_ready, options.timeout
        )
        session.be_known_to_server(client.srv_name)
        while True:
            start_s = time.monotonic()
            filled.stamp(session.node.get_clock().now().to_msg())
            if not options.json:
                say_document(f"requester: making request: {filled.message!r}\n")
            answer = _answer(session, client, filled.message, options.timeout)
            if options.json:
                from arm_node.messages.text import to_plain

                print_json(to_plain(answer))
            else:
                say_document(f"response:\n{answer!r}\n")
            if options.rate is None:
                return
            session.spin_for(max(0.0, start_s + 1.0 / options.rate - time.monotonic()))


def _answer(session: "CommandSession", client: Any, request: Any, timeout_s: float | None) -> Any:
    name = client.srv_name
    answer = session.answer(
        client.call_async(request),
        name,
        client.service_is_ready,
        timeout_s,
        lambda: f"waiting for the answer of {name}...",
    )
    if answer is None:
        raise UnansweredError(f"no answer from {name} within {timeout_s:g} s")
    return answer


EVENTS = "_service_event"
QUEUE = 100


@verb(
    Argument(
        "service_name",
        help="such as /controller_manager/list_controllers",
        completer=completers.services,
    ),
    Argument("service_type", nargs="?", help="default: the service's own type"),
    Argument("--timeout", type=positive_number, metavar="SECONDS", help="end after this time"),
    JSON,
    epilog="A node publishes its requests and responses only if service introspection is enabled, "
    "for example with rclpy's configure_introspection().",
)
def echo(options: argparse.Namespace) -> None:
    """Print the events of the service until a signal or the timeout."""
    from arm_node.messages.text import to_plain, to_yaml

    count = 0

    def show(event: object) -> None:
        nonlocal count
        count += 1
        if options.json:
            print_json(to_plain(event))
        else:
            say_document(to_yaml(event), end="---\n")

    with connect() as session:
        from arm_cli.ros.graph import Graph

        name = session.full_name(options.service_name)
        type_name = options.service_type or Graph(session).find_service(name)[0]
        event_class = load_class(InterfaceIndex().find(type_name, ("srv",))).Event
        topic = f"{name}/{EVENTS}"
        session.node.create_subscription(event_class, topic, show, QUEUE)

        def silence() -> str:
            return f"waiting for {topic}: is service introspection enabled in its node?"

        session.wait_until(lambda: count > 0, silence, options.timeout)
        if count:
            session.wait_until(lambda: False, timeout_s=options.timeout)
    if not count:
        raise UnansweredError(f"no event of {name} within {options.timeout:g} s")
