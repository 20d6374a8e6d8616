"""`arm sim step`: advances a paused simulation by control periods or by simulation time."""

import argparse
import math
from typing import TYPE_CHECKING

from arm_cli.arguments import Argument, Exclusive, Flag, verb
from arm_cli.sim.simulation import NAMESPACE, ask_simulation

if TYPE_CHECKING:
    from arm_cli.sim.simulation import SimulationClient

ROUNDING = 1e-6
"""A time this close to the end of a control period, as a fraction of the period, is that end."""


def _seconds(text: str) -> float:
    try:
        seconds = float(text)
    except ValueError:
        seconds = math.nan
    if not 0.0 < seconds < math.inf:
        raise argparse.ArgumentTypeError(f"{text!r} is not a number of seconds above 0")
    return seconds


@verb(
    Argument("count", nargs="?", type=int, help="number of control periods (default 1)"),
    Exclusive(
        Argument(
            "--seconds",
            type=_seconds,
            help="advance by this much simulation time, rounded up to a whole control period",
        ),
        Argument(
            "--until",
            type=_seconds,
            metavar="TIME",
            help="advance to the first control period that ends at or after this simulation time",
        ),
    ),
    Flag("--with-sensors", help="take every picture that is due, and wait until all are published"),
    NAMESPACE,
)
def run(options: argparse.Namespace) -> None:
    """Advance the simulation, and wait until the states of the last step have been published.

    Raises:
        SimulationRefusedError: it is not paused, or its time is past `--until`.
        CommandUsageError: the number of steps is below 1, or both a number and a time are given.
    """
    _check(options)
    service = "step_simulation_with_sensors" if options.with_sensors else "step_simulation"
    with ask_simulation(options.namespace) as simulation:
        steps = _steps(options, simulation)
        simulation.ask("StepSimulation", service, patiently=True, steps=steps)


def _check(options: argparse.Namespace) -> None:
    from arm_cli.errors import CommandUsageError

    if options.count is None:
        return
    if options.count < 1:
        raise CommandUsageError(f"the number of steps is {options.count}; it must be at least 1")
    if options.seconds is not None or options.until is not None:
        raise CommandUsageError("give a number of steps, or --seconds, or --until")


def _steps(options: argparse.Namespace, simulation: "SimulationClient") -> int:
    seconds: float | None = options.seconds
    end_s: float | None = options.until
    if seconds is None and end_s is None:
        return options.count or 1
    figures = simulation.statistics()["time"]
    period_s, now_s = float(figures["control period (s)"]), float(figures["simulated time (s)"])
    if seconds is not None:
        return max(1, math.ceil(seconds / period_s - ROUNDING))
    assert end_s is not None
    steps = math.ceil((end_s - now_s) / period_s - ROUNDING)
    if steps < 1:
        from arm_cli.errors import SimulationRefusedError

        raise SimulationRefusedError(
            f"the simulation is already at {now_s:.3f} s, past {end_s:g} s"
        )
    return steps
