"""`arm topic pub`: publishes messages once, several times or at a rate."""

import argparse
import itertools
import sys
from collections.abc import Sequence
from dataclasses import dataclass
from typing import TYPE_CHECKING, Any

from arm_cli.arguments import (
    Argument,
    Exclusive,
    Flag,
    node_name,
    positive_number,
    positive_number_or_zero,
    positive_whole_number,
    verb,
    whole_number,
)
from arm_cli.errors import CommandUsageError, MessageError, NoSuchNameError, UnansweredError
from arm_cli.interface_types import InterfaceIndex, InterfaceType, load_class
from arm_cli.output import complain, say, say_document
from arm_cli.qos_options import qos_arguments, qos_choice
from arm_cli.ros import completers
from arm_cli.ros.connection import connect
from arm_cli.word_completion import message_names
from arm_node.messages import MessageValueError
from arm_node.names import describe_known
from arm_node.user_file import read_text

if TYPE_CHECKING:
    from arm_cli.ros.session import CommandSession
    from arm_node.messages.filling import FilledMessage

KEEP_ALIVE_S = 0.1
AFTER_MATCH_S = 0.4
"""How long to wait after a match, because messages sent at that very moment may be lost."""


@verb(
    Argument(
        "topic_name", help="such as /position_controller/commands", completer=completers.topics
    ),
    Argument(
        "message_type", help="such as std_msgs/msg/Float64MultiArray", completer=message_names
    ),
    Argument("values", nargs="?", default="", help="fields as YAML, such as 'data: [0.0, 0.5]'"),
    Flag("--stdin", help="read the values from stdin"),
    Argument(
        "--yaml-file",
        metavar="FILE",
        help="publish the messages in a file, one after another, in the form of `arm topic echo`",
    ),
    Argument("-r", "--rate", type=positive_number, default=1.0, metavar="HZ", help="default 1 Hz"),
    Exclusive(
        Flag("-1", "--once", help="publish once and end"),
        Argument(
            "-t", "--times", type=positive_whole_number, metavar="N", help="publish N times and end"
        ),
    ),
    Argument(
        "-w",
        "--wait-matching-subscriptions",
        type=whole_number,
        metavar="N",
        help="wait for N matching subscriptions (default 1 with --once or --times, else 0)",
    ),
    Argument(
        "--max-wait-time-secs",
        type=positive_number,
        metavar="SECONDS",
        help="how long to wait for them (default: forever)",
    ),
    Argument(
        "-p",
        "--print",
        type=whole_number,
        default=1,
        metavar="N",
        help="print only every Nth message; 0 prints none",
    ),
    Argument(
        "--keep-alive",
        type=positive_number_or_zero,
        default=KEEP_ALIVE_S,
        metavar="SECONDS",
        help=f"how long to stay after the last message has arrived (default {KEEP_ALIVE_S})",
    ),
    Argument(
        "-n", "--node-name", type=node_name, metavar="NAME", help="name of the publishing node"
    ),
    Flag("-s", "--use-sim-time", help="let 'auto' and 'now' use /clock"),
    qos_arguments("reliable, volatile, the last 10"),
)
def pub(options: argparse.Namespace) -> None:
    """Publish the messages."""
    type_ = InterfaceIndex().find(options.message_type, ("msg",))
    messages = _messages(options, type_)
    times = 1 if options.once else options.times
    wanted = options.wait_matching_subscriptions
    if wanted is None:
        wanted = 0 if times is None else 1
    if options.yaml_file is not None:
        times = min(times or len(messages), len(messages))
    with connect(options.node_name, options.use_sim_time) as session:
        publication = _Publication(
            session,
            session.full_name(options.topic_name),
            type_.full_name,
            messages,
            options.print,
        )
        publication.open(options)
        publication.wait_for(wanted, options.max_wait_time_secs)
        say("publisher: beginning loop")
        publication.repeat(times, 1.0 / options.rate)
        session.wait_for_delivery([publication.publisher], options.keep_alive)


def _messages(options: argparse.Namespace, type_: InterfaceType) -> list["FilledMessage"]:
    """Return the messages to publish: one message, or those of a file."""
    from arm_node.messages.filling import fill_message, read_yaml

    given = [bool(options.values), options.stdin, options.yaml_file is not None]
    if sum(given) > 1:
        raise CommandUsageError("give the values once: as an argument, with --stdin or --yaml-file")
    class_ = load_class(type_)
    if options.yaml_file is not None:
        return _messages_of_file(options.yaml_file, class_, type_.full_name)
    text = sys.stdin.read() if options.stdin else options.values
    filled = fill_message(class_(), read_yaml(text, type_.full_name))
    _say_notes(filled, "")
    return [filled]


def _messages_of_file(path: str, class_: type, type_name: str) -> list["FilledMessage"]:
    from arm_node.messages.filling import fill_message, read_yaml_documents

    try:
        text = read_text(path)
    except (OSError, UnicodeDecodeError) as error:
        raise NoSuchNameError(f"--yaml-file {path}: {error}") from error
    try:
        documents = read_yaml_documents(text, type_name)
    except MessageValueError as error:
        raise MessageError(f"--yaml-file {path}: {error}") from error
    if not documents:
        raise MessageError(f"--yaml-file {path}: the file holds no message")
    messages: list[FilledMessage] = []
    for number, values in enumerate(documents, start=1):
        place = f"--yaml-file {path}: message {number}: "
        try:
            messages.append(fill_message(class_(), values))
        except MessageValueError as error:
            raise MessageError(f"{place}{error}") from error
        _say_notes(messages[-1], place)
    return messages


def _say_notes(filled: "FilledMessage", place: str) -> None:
    for note in filled.notes:
        complain(f"arm topic pub: {place}{note}")


@dataclass(slots=True)
class _Publication:
    session: "CommandSession"
    topic: str
    type_name: str
    messages: Sequence["FilledMessage"]
    print_every: int
    publisher: Any = None

    def open(self, options: argparse.Namespace) -> None:
        from arm_cli.ros.qos import qos_profile

        profile = qos_profile(qos_choice(options), "default")
        message_class = type(self.messages[0].message)
        self.publisher = self.session.node.create_publisher(message_class, self.topic, profile)

    def wait_for(self, subscriptions: int, timeout_s: float | None) -> None:
        if not subscriptions:
            return
        from arm_cli.ros.graph import Graph

        graph = Graph(self.session)

        def matched() -> bool:
            ends = (*graph.subscriptions(self.topic), *graph.publishers(self.topic))
            self._check_type({info.topic_type for info in ends})
            return self.publisher.get_subscription_count() >= subscriptions

        def notice() -> str:
            text = f"Waiting for at least {subscriptions} matching subscription(s)..."
            near = describe_known(self.topic, graph.topics())
            there = graph.subscriptions(self.topic)
            return f"{text} {near}" if near.startswith("did") and not there else text

        if not self.session.wait_until(matched, notice, timeout_s):
            raise UnansweredError(
                f"{self.topic} has fewer than {subscriptions} matching subscription(s) after "
                f"{timeout_s:g} s"
            )
        self.session.spin_for(AFTER_MATCH_S)

    def _check_type(self, types: set[str]) -> None:
        if types and self.type_name not in types:
            raise CommandUsageError(
                f"the type of {self.topic} is {', '.join(sorted(types))}, not {self.type_name}"
            )

    def repeat(self, times: int | None, period_s: float) -> None:
        """Publish the messages in turn, from the first again after the last, `times` in total."""
        count = 0
        following = itertools.cycle(self.messages)

        def publish() -> None:
            nonlocal count
            if count == times:
                return
            count += 1
            filled = next(following)
            filled.stamp(self.session.node.get_clock().now().to_msg())
            if self.print_every and count % self.print_every == 0:
                say_document(f"publishing #{count}: {filled.message!r}\n")
            self.publisher.publish(filled.message)

        publish()
        timer = self.session.node.create_timer(period_s, publish)
        self.session.wait_until(lambda: count == times)
        timer.cancel()
