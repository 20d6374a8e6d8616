"""The hardware spawner's command line."""

import argparse
from collections.abc import Sequence
from dataclasses import dataclass

from arm_control.lifecycle import LifecycleState
from arm_control.manager_command_line import add_controller_manager, add_controller_manager_timeout


@dataclass(frozen=True, slots=True)
class HardwareSpawnerOptions:
    """What a hardware spawner is to do.

    Attributes:
        names: hardware components, in the order to take them on.
        target: state to bring them to.
        controller_manager: node name of the manager, absolute or relative to the namespace.
        controller_manager_timeout_s: how long to wait for the manager; 0 for ever.
    """

    names: tuple[str, ...]
    target: LifecycleState
    controller_manager: str
    controller_manager_timeout_s: float


def parse_hardware_spawner_options(arguments: Sequence[str]) -> HardwareSpawnerOptions:
    """Read the program's own arguments; a mistake ends the process with code 2, as usual."""
    parser = argparse.ArgumentParser(
        prog="hardware_spawner",
        description="Configure or activate hardware components.",
        allow_abbrev=False,
    )
    parser.add_argument("names", nargs="+", metavar="NAME", help="components, in this order")
    add_controller_manager(parser)
    add_controller_manager_timeout(parser)
    target = parser.add_mutually_exclusive_group(required=True)
    for flag, state, meaning in (
        ("--activate", LifecycleState.ACTIVE, "bring them to active, configuring them on the way"),
        ("--configure", LifecycleState.INACTIVE, "bring them to inactive"),
    ):
        target.add_argument(flag, action="store_const", const=state, dest="target", help=meaning)
    options = parser.parse_intermixed_args(arguments)
    return HardwareSpawnerOptions(
        names=tuple(options.names),
        target=options.target,
        controller_manager=options.controller_manager,
        controller_manager_timeout_s=options.controller_manager_timeout,
    )
