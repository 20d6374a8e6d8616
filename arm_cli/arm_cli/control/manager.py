"""The controller manager that a verb asks."""

import argparse
import sys
from collections.abc import Iterator
from contextlib import contextmanager
from typing import TYPE_CHECKING, Any

from arm_cli.names import absolute_name
from arm_cli.ros import completers
from arm_cli.ros.connection import connect
from arm_cli.word_completion import complete_with

if TYPE_CHECKING:
    from arm_cli.ros.controller_manager import ControllerManagerClient

DEFAULT_MANAGER = "/controller_manager"

ACTIVE, INACTIVE, UNCONFIGURED, OTHER = 92, 96, 93, 91
"""Terminal colours of states."""


def add_manager_arguments(parser: argparse.ArgumentParser) -> None:
    """Add the choice of the manager."""
    complete_with(
        parser.add_argument(
            "-c",
            "--controller-manager",
            default=DEFAULT_MANAGER,
            metavar="NODE",
            help=f"name of the manager's node (default {DEFAULT_MANAGER})",
        ),
        completers.nodes,
    )
    # A manager that is named may always be a hidden node; but lines written for ros2 say so.
    parser.add_argument("--include-hidden-nodes", action="store_true", help=argparse.SUPPRESS)


@contextmanager
def ask_manager(options: argparse.Namespace) -> Iterator["ControllerManagerClient"]:
    """Give a client of the manager's services."""
    with connect() as session:
        from arm_cli.ros.controller_manager import ControllerManagerClient

        yield ControllerManagerClient(session, absolute_name(options.controller_manager))


def refuse(sentence: str) -> int:
    """Say why not, in the very words of ros2 control; return the exit code."""
    sys.stdout.flush()
    print(sentence, file=sys.stderr)
    return 1


def state_colour(state: str) -> int:
    """Return the terminal colour of a controller's state."""
    return {"active": ACTIVE, "inactive": INACTIVE, "unconfigured": UNCONFIGURED}.get(state, OTHER)


def plain(messages: list[Any]) -> list[Any]:
    """Return messages as dicts, for `--json`."""
    from arm_cli.messages.text import to_plain

    return [to_plain(message) for message in messages]
