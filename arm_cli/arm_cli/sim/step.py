"""`arm sim step`: advance a paused simulation."""

import argparse

from arm_cli.sim.simulation import add_namespace_argument, ask_simulation


def add_arguments(parser: argparse.ArgumentParser) -> None:
    """Add the verb's arguments."""
    parser.add_argument(
        "count", nargs="?", type=int, default=1, help="number of control periods (default 1)"
    )
    add_namespace_argument(parser)


def run(options: argparse.Namespace) -> None:
    """Advance the simulation, and wait for that.

    Raises:
        RefusedError: it is not paused.
        UsageError: the number is none.
    """
    if options.count < 1:
        from arm_cli.errors import UsageError

        raise UsageError(f"the number of steps is {options.count}; 1 is the least")
    with ask_simulation(options) as simulation:
        simulation.ask("StepSimulation", "step_simulation", steps=options.count)
