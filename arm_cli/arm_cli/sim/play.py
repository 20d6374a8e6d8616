"""`arm sim play`: let simulated time go on."""

import argparse

from arm_cli.sim.simulation import PLAYING, add_namespace_argument, ask_simulation


def add_arguments(parser: argparse.ArgumentParser) -> None:
    """Add the verb's arguments."""
    add_namespace_argument(parser)


def run(options: argparse.Namespace) -> None:
    """Let the simulation go on.

    Raises:
        RefusedError: it goes on already, or there is no world.
    """
    with ask_simulation(options) as simulation:
        simulation.go_to(PLAYING)
