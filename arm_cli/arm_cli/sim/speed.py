"""`arm sim speed`: shows and changes the real-time factor of a running simulation."""

import argparse
import math

from arm_cli.arguments import Argument, verb
from arm_cli.output import say
from arm_cli.sim.simulation import NAMESPACE, ask_simulation

PARAMETER = "real_time_factor"


def _factor(text: str) -> float:
    try:
        factor = float(text)
    except ValueError:
        factor = math.nan
    if not 0.0 <= factor < math.inf:
        raise argparse.ArgumentTypeError(f"{text!r} is not a finite number of at least 0")
    return factor


@verb(
    Argument(
        "factor",
        nargs="?",
        type=_factor,
        help="simulated seconds per second; 0 is as fast as possible (default: print it)",
    ),
    NAMESPACE,
)
def run(options: argparse.Namespace) -> None:
    """Set the factor, or print it.

    Raises:
        UnansweredError: no simulation answers.
        SimulationRefusedError: it refuses the factor.
    """
    with ask_simulation(options.namespace, must_run=options.factor is None) as simulation:
        if options.factor is None:
            from arm_cli.parameter_values import content_of

            say(f"{content_of(simulation.parameters().value(PARAMETER)):g}")
        else:
            simulation.set_parameter(PARAMETER, options.factor)
