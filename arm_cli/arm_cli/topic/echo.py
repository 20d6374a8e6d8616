"""`arm topic echo`: prints the messages of a topic."""

import argparse
import time
from collections.abc import Callable
from dataclasses import dataclass, field
from typing import Any

from arm_cli.arguments import (
    JSON,
    Argument,
    Flag,
    positive_number,
    positive_whole_number,
    verb,
    whole_number,
)
from arm_cli.errors import CommandUsageError, UnansweredError
from arm_cli.interface_types import InterfaceIndex, load_class
from arm_cli.output import print_json, say, say_document
from arm_cli.qos_options import qos_arguments, qos_choice
from arm_cli.ros import completers
from arm_cli.ros.connection import connect
from arm_cli.topic.message_parts import FILTER, message_filter
from arm_cli.word_completion import message_names

TRUNCATE_LENGTH = 128


@verb(
    Argument("topic_name", help="such as /joint_states", completer=completers.topics),
    Argument(
        "message_type", nargs="?", help="default: the topic's own type", completer=message_names
    ),
    Flag("--once", help="end after one message"),
    Argument("-n", "--times", type=positive_whole_number, metavar="N", help="end after N messages"),
    Argument("--timeout", type=positive_number, metavar="SECONDS", help="end after this time"),
    Argument("--field", metavar="PATH", help="print only a part, such as pose.position"),
    FILTER,
    Flag("-i", "--include-message-info", help="also print its times and number"),
    # Accepted because command lines for ros2 use them. They are not needed here.
    *(
        Flag(*names, help=argparse.SUPPRESS)
        for names in (("-s", "--use-sim-time"), ("--no-lost-messages",))
    ),
    Flag("--csv", help="print values separated by commas"),
    JSON,
    Flag("--raw", help="print the serialized bytes"),
    Flag("--flow-style", help="print collections in one line"),
    Flag("--no-arr", help="print placeholders for arrays"),
    Flag("--no-str", help="print placeholders for strings"),
    Flag("-f", "--full-length", help="truncate nothing"),
    Argument(
        "-l",
        "--truncate-length",
        type=whole_number,
        default=TRUNCATE_LENGTH,
        metavar="N",
        help=f"cut longer arrays and strings (default {TRUNCATE_LENGTH})",
    ),
    qos_arguments("a profile that matches the topic's publishers"),
)
def echo(options: argparse.Namespace) -> None:
    """Print the messages."""
    printer = _printer(options)
    class_ = None
    if options.message_type:
        class_ = load_class(InterfaceIndex().find(options.message_type, ("msg",)))
        printer.check(class_)
    with connect() as session:
        from arm_cli.ros.listeners import TopicListener
        from arm_cli.ros.qos import qos_profile

        listener = TopicListener(session, options.topic_name)
        if class_ is None:
            class_ = listener.find_class()
            printer.check(class_)
        choice = qos_choice(options)
        profile = (
            qos_profile(choice, "sensor_data") if choice.is_given else listener.matching_profile()
        )
        listener.subscribe(class_, printer.take, profile, raw=options.raw)
        start_s = time.monotonic()
        session.wait_until(
            lambda: printer.count > 0,
            lambda: printer.refusal(listener.topic) or listener.silence(),
            options.timeout,
        )
        rest_s = None if options.timeout is None else options.timeout + start_s - time.monotonic()
        session.wait_until(printer.is_done, timeout_s=rest_s)
    if printer.count == 0:
        nothing = printer.refusal(listener.topic) or f"no message on {listener.topic}"
        raise UnansweredError(f"{nothing} within {options.timeout:g} s")


def _printer(options: argparse.Namespace) -> "MessagePrinter":
    from arm_cli.topic.message_parts import FieldPath
    from arm_node.messages.text import Abridgement

    if options.once and options.times is not None:
        raise CommandUsageError("--once and --times exclude each other")
    if options.raw and (options.field or options.csv or options.json or options.filter):
        raise CommandUsageError("--raw excludes --field, --filter, --csv and --json")
    return MessagePrinter(
        style=next((s for s in ("raw", "json", "csv") if getattr(options, s)), "yaml"),
        flow_style=options.flow_style,
        abridgement=Abridgement(
            None if options.full_length or options.json else options.truncate_length,
            options.no_arr,
            options.no_str,
        ),
        path=FieldPath.parse(options.field) if options.field else None,
        accepts=message_filter(options.filter or "True"),
        with_info=options.include_message_info,
        limit=1 if options.once else options.times,
    )


@dataclass(slots=True)
class MessagePrinter:
    """Prints messages in one of the styles, up to a limit.

    Attributes:
        count: the number of messages printed so far.
        refused: the number of messages that the filter did not let pass.
    """

    style: str
    flow_style: bool
    abridgement: Any
    path: Any
    accepts: Callable[[Any], bool]
    with_info: bool
    limit: int | None
    count: int = field(default=0, init=False)
    refused: int = field(default=0, init=False)

    def check(self, message_class: type) -> None:
        """Check the field against the type.

        Raises:
            MessageError: there is no such field.
        """
        if self.path is not None:
            self.path.check(message_class)

    def is_done(self) -> bool:
        """Return whether the limit is reached."""
        return self.limit is not None and self.count >= self.limit

    def take(self, message: Any, info: dict[str, Any]) -> None:
        """Print a message, unless the limit is reached."""
        if self.is_done():
            return
        part = message if self.path is None else self.path.of(message)
        if self.accepts(part):
            self._print(part, info if self.with_info else {})
            self.count += 1
        else:
            self.refused += 1

    def refusal(self, topic: str) -> str:
        """Return a notice that no message has passed the filter, "" if none has arrived."""
        if not self.refused:
            return ""
        messages = "1 message" if self.refused == 1 else f"{self.refused} messages"
        return f"{messages} on {topic}, but none for which --filter holds"

    def _print(self, part: Any, info: dict[str, Any]) -> None:
        from arm_node.messages.text import is_message, to_csv, to_plain, to_yaml

        if self.style == "json":
            plain = to_plain(part, self.abridgement)
            print_json({"info": info, "message": plain} if info else plain)
        elif self.style == "csv":
            values = [str(value) for value in info.values()]
            say(",".join([*values, to_csv(part, self.abridgement)]))
        else:
            header = "".join(f"{key}: {value}\n" for key, value in info.items())
            if header:
                say_document(header, end="---\n")
            if is_message(part):
                say_document(to_yaml(part, self.abridgement, self.flow_style), end="---\n")
            else:
                (say if isinstance(part, str) else say_document)(str(part))
                say("---")
