"""`arm sim pause`: let simulated time stand still."""

import argparse

from arm_cli.sim.simulation import PAUSED, add_namespace_argument, ask_simulation


def add_arguments(parser: argparse.ArgumentParser) -> None:
    """Add the verb's arguments."""
    add_namespace_argument(parser)


def run(options: argparse.Namespace) -> None:
    """Pause the simulation.

    Raises:
        RefusedError: it stands still already.
    """
    with ask_simulation(options) as simulation:
        simulation.go_to(PAUSED)
