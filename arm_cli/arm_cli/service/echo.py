"""`arm service echo`: prints the requests and responses that a service publishes."""

import argparse

from arm_cli.arguments import JSON, Argument, positive_number, verb
from arm_cli.errors import UnansweredError
from arm_cli.interfaces.index import InterfaceIndex, load_class
from arm_cli.output import print_json, say_document
from arm_cli.ros import completers
from arm_cli.ros.connection import connect

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
def run(options: argparse.Namespace) -> None:
    """Print the events of the service until a signal or the timeout.

    Raises:
        NoSuchNameError: there is no such service or type.
        UnansweredError: there is no event within `--timeout`.
        StoppedError: a signal arrived.
    """
    from arm_cli.messages.text import to_plain, to_yaml

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
