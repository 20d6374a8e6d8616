"""`arm action send_goal`: send a goal and wait for its result."""

import argparse
import sys
from contextlib import closing
from typing import TYPE_CHECKING

from arm_cli.arguments import Argument, Flag, positive_number, verb
from arm_cli.errors import CommandUsageError, UnansweredError
from arm_cli.interface_types import InterfaceIndex, load_class
from arm_cli.output import complain, say
from arm_cli.ros import completers
from arm_cli.ros.connection import connect
from arm_node.names import describe_known

if TYPE_CHECKING:
    from arm_cli.action.ros_goal import GoalSender
    from arm_cli.ros.session import CommandSession


@verb(
    Argument(
        "action_name",
        help="such as /gripper_action_controller/gripper_cmd",
        completer=completers.actions,
    ),
    Argument("action_type", help="such as control_msgs/action/GripperCommand"),
    Argument("goal", nargs="?", default="", help="fields of the goal as YAML"),
    Flag("--stdin", help="read the goal from stdin"),
    Flag("-f", "--feedback", help="also print the feedback"),
    Argument(
        "--timeout",
        type=positive_number,
        metavar="SECONDS",
        help="how long to wait for a server, and how long a goal may take before it is cancelled",
    ),
)
def send_goal(options: argparse.Namespace) -> None:
    """Send the goal and print its progress and result; Ctrl-C cancels it."""
    type_ = InterfaceIndex().find(options.action_type, ("action",))
    from arm_node.messages.filling import fill_message, read_yaml

    class_ = load_class(type_)
    text = sys.stdin.read() if options.stdin else options.goal
    filled = fill_message(class_.Goal(), read_yaml(text, f"{type_.full_name} goal"))
    for note in filled.notes:
        complain(f"arm action send_goal: {note}")
    with connect() as session:
        from arm_cli.action.ros_goal import GoalSender

        with closing(GoalSender(session, class_, session.full_name(options.action_name))) as sender:
            _wait_for_server(session, sender, type_.full_name, options.timeout)
            sender.wait_until_known()
            sender.send(filled, options.feedback, options.timeout)


def _wait_for_server(
    session: "CommandSession", sender: "GoalSender", type_name: str, timeout_s: float | None
) -> None:
    from arm_cli.ros.graph import Graph

    graph = Graph(session)
    say("Waiting for an action server to become available...")

    def ready() -> bool:
        others = graph.offered_action_types(sender.name)
        if others and type_name not in others:
            raise CommandUsageError(f"{sender.name} is a {', '.join(others)}, not a {type_name}")
        return sender.is_ready()

    def notice() -> str:
        near = describe_known(sender.name, [n for n in graph.actions() if n != sender.name])
        return f"no server of {sender.name} yet{f'; {near}' if near.startswith('did') else ''}"

    if not session.wait_until(ready, notice, timeout_s):
        raise UnansweredError(f"action {sender.name} has no server (waited {timeout_s:g} s)")
