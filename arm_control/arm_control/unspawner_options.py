"""The unspawner's command line."""

import argparse
from collections.abc import Sequence
from dataclasses import dataclass

from arm_control.manager_command_line import add_controller_manager, add_switch_timeout


@dataclass(frozen=True, slots=True)
class UnspawnerOptions:
    """What an unspawner is to do.

    Attributes:
        names: controllers, in the order to unload them.
        controller_manager: node name of the manager, absolute or relative to the namespace.
        switch_timeout_s: how long the manager may take to switch; 0 for its default.
    """

    names: tuple[str, ...]
    controller_manager: str
    switch_timeout_s: float


def parse_unspawner_options(arguments: Sequence[str]) -> UnspawnerOptions:
    """Read the unspawner's own arguments; a mistake ends the process with code 2, as usual."""
    parser = argparse.ArgumentParser(
        prog="unspawner", description="Deactivate and unload controllers.", allow_abbrev=False
    )
    parser.add_argument("names", nargs="+", metavar="NAME", help="controllers, in this order")
    add_controller_manager(parser)
    add_switch_timeout(parser)
    options = parser.parse_intermixed_args(arguments)
    return UnspawnerOptions(
        names=tuple(options.names),
        controller_manager=options.controller_manager,
        switch_timeout_s=options.switch_timeout,
    )
