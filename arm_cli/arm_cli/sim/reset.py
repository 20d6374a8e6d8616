"""`arm sim reset`: put everything back to where it started."""

import argparse

from arm_cli.sim.simulation import add_namespace_argument, ask_simulation

SCOPE_STATE, SCOPE_SPAWNED = 2, 4


def add_arguments(parser: argparse.ArgumentParser) -> None:
    """Add the verb's arguments."""
    parser.add_argument(
        "--keep-spawned", action="store_true", help="leave what was spawned, and its deletions"
    )
    add_namespace_argument(parser)


def run(options: argparse.Namespace) -> None:
    """Reset poses and velocities and, unless told otherwise, what was spawned and deleted.

    Raises:
        UnansweredError: no simulation answers.
    """
    scope = SCOPE_STATE if options.keep_spawned else SCOPE_STATE | SCOPE_SPAWNED
    with ask_simulation(options) as simulation:
        simulation.ask("ResetSimulation", "reset_simulation", scope=scope)
