"""The controller that a verb is about."""

import argparse
from typing import Any

from arm_cli.control.manager import DEFAULT_MANAGER, ask_manager
from arm_cli.word_completion import complete_with


def add_controller_argument(parser: argparse.ArgumentParser) -> None:
    """Add the controller's name."""
    complete_with(
        parser.add_argument("controller_name", help="such as position_controller"),
        loaded_controllers,
    )


def loaded_controllers(parsed_args: argparse.Namespace, **_: Any) -> list[str]:
    """Return the names of the loaded controllers, for the Tab key."""
    manager = getattr(parsed_args, "controller_manager", None) or DEFAULT_MANAGER
    with ask_manager(argparse.Namespace(controller_manager=manager)) as client:
        return [controller.name for controller in client.controllers()]
