"""What the verbs of `arm control` share: the client of the manager, options and completers."""

import argparse
from collections.abc import Callable, Iterable, Iterator
from contextlib import contextmanager
from typing import TYPE_CHECKING, Any

from arm_cli.arguments import Argument, Flag
from arm_cli.names import absolute_name
from arm_cli.output import complain
from arm_cli.ros import completers
from arm_cli.ros.connection import connect
from arm_node.names import describe_known

if TYPE_CHECKING:
    from arm_node.controller_manager import ControllerManagerClient

DEFAULT_MANAGER = "/controller_manager"

ACTIVE, INACTIVE, UNCONFIGURED, OTHER = 92, 96, 93, 91
"""Terminal colours of states."""


@contextmanager
def ask_manager(options: argparse.Namespace) -> Iterator["ControllerManagerClient"]:
    """Yield a client of the manager's services."""
    with connect() as session:
        from arm_cli.ros.controller_manager import manager_client

        manager = absolute_name(options.controller_manager)
        yield manager_client(session, manager, or_the_only_one=manager == DEFAULT_MANAGER)


def refuse(sentence: str) -> int:
    """Print an error in the exact words of ros2 control; return the exit code."""
    complain(sentence)
    return 1


def suggestion(name: str, known: Iterable[str]) -> str:
    """Return "; did you mean ...?" if an unknown name is similar to a known one, else ""."""
    names = list(known)
    hint = "" if name in names else describe_known(name, names)
    return f"; {hint}" if hint.startswith("did") else ""


def state_colour(state: str) -> int:
    """Return the terminal colour of a controller's state."""
    return {"active": ACTIVE, "inactive": INACTIVE, "unconfigured": UNCONFIGURED}.get(state, OTHER)


def plain(messages: list[Any]) -> list[Any]:
    """Return messages as dicts, for `--json`."""
    from arm_node.messages.text import to_plain

    return [to_plain(message) for message in messages]


def loaded_controllers(parsed_args: argparse.Namespace, **_: Any) -> list[str]:
    """Return the names of the loaded controllers, for the Tab key."""
    return _ask(parsed_args, lambda manager: list(manager.states()))


def loadable_controllers(parsed_args: argparse.Namespace, **_: Any) -> list[str]:
    """Return the controllers in the manager's parameters that are not loaded, for the Tab key."""
    return _ask(parsed_args, lambda manager: sorted({*manager.loadable()} - {*manager.states()}))


def hardware_components(parsed_args: argparse.Namespace, **_: Any) -> list[str]:
    """Return the names of the hardware components, for the Tab key."""
    return _ask(parsed_args, lambda manager: [c.name for c in manager.hardware_components()])


def _ask(
    parsed_args: argparse.Namespace, ask: Callable[["ControllerManagerClient"], list[str]]
) -> list[str]:
    manager = getattr(parsed_args, "controller_manager", None) or DEFAULT_MANAGER
    with ask_manager(argparse.Namespace(controller_manager=manager)) as client:
        return ask(client)


CONTROLLER = Argument(
    "controller_name", completer=loaded_controllers, help="such as position_controller"
)
MANAGER = (
    Argument(
        "-c",
        "--controller-manager",
        default=DEFAULT_MANAGER,
        metavar="NODE",
        completer=completers.nodes,
        help=f"name of the manager's node (default {DEFAULT_MANAGER}, or the only one)",
    ),
    # Accepted because command lines for ros2 use it. A named node may always be hidden here.
    Flag("--include-hidden-nodes", help=argparse.SUPPRESS),
)
"""The option that selects the manager."""
