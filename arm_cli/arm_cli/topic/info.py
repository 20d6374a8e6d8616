"""`arm topic info`: a topic's type, and who is on it."""

import argparse
from typing import Any

from arm_cli.names import absolute_name
from arm_cli.output import add_json_argument, print_json
from arm_cli.ros import completers
from arm_cli.ros.connection import connect
from arm_cli.word_completion import complete_with


def add_arguments(parser: argparse.ArgumentParser) -> None:
    """Add the verb's arguments."""
    complete_with(
        parser.add_argument("topic_name", help="such as /joint_states"), completers.topics
    )
    parser.add_argument(
        "-v", "--verbose", action="store_true", help="every end point with its quality of service"
    )
    add_json_argument(parser)


def run(options: argparse.Namespace) -> None:
    """Print the topic's type and the number of its end points.

    Raises:
        NotFoundError: there is no such topic.
    """
    with connect() as session:
        from arm_cli.ros.graph import Graph

        graph = Graph(session)
        graph.settle()
        types = graph.find_topic(options.topic_name)
        topic = absolute_name(options.topic_name)
        publishers, subscriptions = graph.publishers(topic), graph.subscriptions(topic)
    if options.json:
        print_json(
            {
                "types": types,
                "publishers": [_plain(info) for info in publishers],
                "subscriptions": [_plain(info) for info in subscriptions],
            }
        )
        return
    end = "\n\n" if options.verbose else "\n"
    print(f"Type: {types[0] if len(types) == 1 else types}", end=end)
    for title, infos in (("Publisher", publishers), ("Subscription", subscriptions)):
        print(f"{title} count: {len(infos)}", end=end)
        for info in infos if options.verbose else ():
            print(info, end=end)


def _plain(info: Any) -> dict[str, Any]:
    profile = info.qos_profile
    return {
        "node": f"{info.node_namespace.rstrip('/')}/{info.node_name}",
        "type": info.topic_type,
        "reliability": profile.reliability.name.lower(),
        "durability": profile.durability.name.lower(),
        "liveliness": profile.liveliness.name.lower(),
    }
