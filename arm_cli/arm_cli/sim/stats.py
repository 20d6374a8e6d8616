"""`arm sim stats`: prints the figures of a running simulation."""

import argparse

from arm_cli.output import add_json_argument, print_json, say
from arm_cli.sim.simulation import add_namespace_argument, ask_simulation


def add_arguments(parser: argparse.ArgumentParser) -> None:
    """Add the verb's arguments."""
    add_json_argument(parser)
    add_namespace_argument(parser)


def run(options: argparse.Namespace) -> None:
    """Print the figures of the last second or two.

    Raises:
        NoSuchNameError: no simulation runs.
    """
    with ask_simulation(options, must_run=True) as simulation:
        parts = simulation.statistics()
    if options.json:
        print_json(parts)
        return
    width = max(len(name) for figures in parts.values() for name in figures)
    for part, figures in parts.items():
        say(f"{part}:")
        for name, value in figures.items():
            say(f"  {name:<{width}}  {value}")
