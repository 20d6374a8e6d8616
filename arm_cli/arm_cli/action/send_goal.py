"""`arm action send_goal`: send a goal and wait for its result."""

import argparse
import sys
from contextlib import closing

from arm_cli.arguments import Argument, Flag, positive_number, verb
from arm_cli.interface_types import InterfaceIndex, load_class
from arm_cli.output import complain, say
from arm_cli.ros import completers
from arm_cli.ros.connection import connect


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
        from arm_cli.ros.graph import Graph

        with closing(GoalSender(session, class_, session.full_name(options.action_name))) as sender:
            say("Waiting for an action server to become available...")
            Graph(session).wait_for_server(
                "action", sender.name, type_.full_name, sender.is_ready, options.timeout
            )
            sender.wait_until_known()
            sender.send(filled, options.feedback, options.timeout)
