"""`arm sim delete`: take things out of a running simulation."""

import argparse

from arm_cli.sim.simulation import add_namespace_argument, ask_simulation


def add_arguments(parser: argparse.ArgumentParser) -> None:
    """Add the verb's arguments."""
    parser.add_argument("entities", nargs="+", metavar="ENTITY", help="names, as by arm sim info")
    add_namespace_argument(parser)


def run(options: argparse.Namespace) -> None:
    """Delete the entities, one after another.

    Raises:
        RefusedError: there is no such entity, or it stays.
    """
    with ask_simulation(options) as simulation:
        for entity in options.entities:
            simulation.ask("DeleteEntity", "delete_entity", entity=entity)
