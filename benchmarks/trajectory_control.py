"""Switching, the trajectory controller at 500 Hz, how well it tracks and when its results come."""

import argparse
import contextlib
from collections.abc import Iterator
from concurrent.futures import ThreadPoolExecutor
from pathlib import Path
from typing import Any

import harness
import numpy as np
import psutil

CONTROLLERS = (
    harness.CONTROLLERS.replace(
        # The launch starts the first that can have the joints; the client then loads the other.
        "position_controllers/JointGroupPositionController\n",
        "position_controllers/JointGroupPositionController\n"
        "    joint_trajectory_controller:\n"
        "      type: joint_trajectory_controller/JointTrajectoryController\n",
    )
    + """\
joint_trajectory_controller:
  ros__parameters:
    joints: [j0, j1, j2, j3]
    command_interfaces: [position]
    state_interfaces: [position, velocity]
"""
)
CLIENT = Path(__file__).with_name("trajectory_client.py")


@contextlib.contextmanager
def client(job: str, *arguments: str, rate_hz: int = 100) -> Iterator[tuple[Any, Any]]:
    """Run the suite and a job of the client; yield both."""
    with harness.suite("camera:=none", rate_hz=rate_hz, parameters=CONTROLLERS) as running:
        working = harness.Client(job, *arguments, script=CLIENT)
        yield running, working
        working.stop()


def switching(count: int) -> harness.Row:
    """Measure from the call of switch_controller to its answer."""
    with client("switch", "--count", str(count)) as (_, working):
        p50, p99 = harness.percentiles(working.answer()["latencies_s"], 50, 99)
    return harness.Row(
        "100 Hz: switch_controller, call to answer p50 / p99",
        f"{p50 * 1e3:.1f} / {p99 * 1e3:.1f} ms (n={count})",
        "30 ms",
    )


def busy(rate_hz: int, seconds: float) -> list[harness.Row]:
    """Measure cycles that are not over when the next is due, and the processor meanwhile."""
    with client("busy", "--seconds", str(seconds), rate_hz=rate_hz) as (running, working):
        working.answer()
        whole = psutil.Process(running.process.pid)
        everything = [whole, *whole.children(recursive=True)]
        with ThreadPoolExecutor() as pool:
            percents = list(pool.map(lambda p: harness.cpu_percent(p, seconds - 1), everything))
        answer = working.answer()
    late = answer["overruns"] / (rate_hz * answer["seconds"])
    return [
        harness.Row(
            f"{rate_hz} Hz, 4 joints on a trajectory: cycles on time",
            f"{100 * (1 - late):.2f} %",
            "99.5 %",
        ),
        harness.Row(
            f"{rate_hz} Hz, 4 joints on a trajectory: CPU of all processes; of the simulation's",
            f"{sum(percents):.1f} %; {max(percents):.1f} % of a core",
            "35 %",
        ),
    ]


def tracking() -> harness.Row:
    """Measure the error of the joints on a quintic through five points in five seconds."""
    with client("track") as (_, working):
        errors = np.array(working.answer()["errors_rad"])
    rms = float(np.sqrt((errors**2).mean()))
    return harness.Row(
        "5 s quintic through 5 way points: joint error rms / max",
        f"{rms * 1e3:.3f} / {np.abs(errors).max() * 1e3:.3f} mrad ({len(errors)} cycles)",
        "5 mrad",
    )


def results(count: int) -> harness.Row:
    """Measure simulated time from the cycle in which a goal is met to its result."""
    with client("results", "--count", str(count)) as (_, working):
        periods = np.array(working.answer()["delays_s"]) * 100
    return harness.Row(
        "100 Hz: goal met to FollowJointTrajectory result p50 / max",
        f"{np.median(periods):.1f} / {periods.max():.1f} control periods (n={count})",
        "2",
    )


def main() -> None:
    """Print the table."""
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("--seconds", type=float, default=20.0)
    parser.add_argument("--count", type=int, default=40)
    arguments = parser.parse_args()
    rows = [
        switching(arguments.count),
        *busy(500, arguments.seconds),
        tracking(),
        results(arguments.count),
    ]
    harness.print_table("Trajectory control", rows)


if __name__ == "__main__":
    main()
