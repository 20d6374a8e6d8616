"""`arm control switch_controllers`: activate and deactivate controllers in one step."""

import argparse

from arm_cli.command_parser import positive_number
from arm_cli.control.controller_argument import loaded_controllers
from arm_cli.control.manager import add_manager_arguments, ask_manager
from arm_cli.word_completion import complete_with

DEFAULT, BEST_EFFORT, STRICT = 0, 1, 2
"""Strictness as in controller_manager_msgs/srv/SwitchController; 0 leaves it to the manager."""


def add_arguments(parser: argparse.ArgumentParser) -> None:
    """Add the verb's arguments."""
    for option in ("--deactivate", "--activate"):
        complete_with(
            parser.add_argument(option, nargs="*", default=[], metavar="CONTROLLER"),
            loaded_controllers,
        )
    group = parser.add_mutually_exclusive_group()
    group.add_argument("--strict", action="store_true", help="all or nothing")
    group.add_argument("--best-effort", action="store_true", help="as many as possible")
    parser.add_argument(
        "--activate-asap", action="store_true", help="passed on to the controller manager"
    )
    parser.add_argument("--switch-timeout", type=positive_number, default=5.0, metavar="SECONDS")
    add_manager_arguments(parser)


def run(options: argparse.Namespace) -> int:
    """Switch; the exit code is 1 where the manager refuses.

    Raises:
        UnansweredError: the manager does not answer.
    """
    strictness = STRICT if options.strict else BEST_EFFORT if options.best_effort else DEFAULT
    with ask_manager(options) as manager:
        response = manager.switch(
            options.activate,
            options.deactivate,
            strictness,
            options.activate_asap,
            options.switch_timeout,
        )
    outcome = "Successfully switched controllers!" if response.ok else "Error switching controllers"
    print(response.message or outcome)
    return 0 if response.ok else 1
