"""`arm sim stats`: prints the figures of a running simulation."""

import argparse

from arm_cli.arguments import JSON, verb
from arm_cli.output import print_json, say
from arm_cli.sim.simulation import NAMESPACE, ask_simulation


@verb(
    JSON,
    NAMESPACE,
)
def run(options: argparse.Namespace) -> None:
    """Print the figures of the last second or two.

    Raises:
        NoSuchNameError: no simulation runs.
    """
    with ask_simulation(options.namespace, must_run=True) as simulation:
        parts = simulation.statistics()
    if options.json:
        print_json(parts)
        return
    width = max(len(name) for figures in parts.values() for name in figures)
    for part, figures in parts.items():
        say(f"{part}:")
        for name, value in figures.items():
            say(f"  {name:<{width}}  {value}")
