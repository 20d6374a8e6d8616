"""1, 4 and 16 arms in one world: rate, lag, processor and memory, at 100 Hz in real time.

Without cameras and without the page. The rates are those that one client in Python receives.
Processor and memory are measured while nobody but the state publishers listens, and again while one
client commands every arm at 100 Hz.
"""

import argparse
import json
import subprocess
import sys
import time
from dataclasses import dataclass
from pathlib import Path
from typing import Any

import harness

CLIENT = Path(__file__).with_name("many_arms_client.py")
RATE_HZ = 100
SETTLING_S = 2.0


def statistics() -> dict[str, Any]:
    """Return the simulation's own figures: of its time, its last ticks and its physics."""
    command = [sys.executable, "-m", "arm_cli", "sim", "stats", "--json"]
    return json.loads(subprocess.run(command, capture_output=True, text=True, check=True).stdout)


@dataclass(frozen=True, slots=True)
class Measured:
    """What is measured with some arms.

    Attributes:
        ready_s: time from `arm launch` until it is ready.
        percent: processor of the simulation and of the state publishers, in % of a core.
        memory_mb: their memory.
        rates_hz: rate of each arm's joint states.
        commanded_percent: processor of the simulation while each arm is commanded.
        figures: the simulation's own.
        latencies_s: times from a command to the first motion.
    """

    ready_s: float
    percent: list[float]
    memory_mb: list[float]
    rates_hz: list[float]
    commanded_percent: float
    figures: dict[str, Any]
    latencies_s: list[float]


def measured(running: harness.Suite, names: list[str], seconds: float, steps: int) -> Measured:
    """Measure the arms in some namespaces."""
    running.wait_until_ready()
    ready_s = time.monotonic() - running.started_s
    time.sleep(SETTLING_S)
    processes = [running.find(name) for name in ("arm_gazebo_node", "robot_state_publisher")]
    percent = [harness.cpu_percent(process, seconds) for process in processes]
    memory_mb = [process.memory_info().rss / 1e6 for process in processes]
    counting = harness.Client("count", str(seconds), *names, script=CLIENT)
    rates_hz = list(counting.answer().values())
    counting.process.wait(10.0)
    commanding = harness.Client("command", "0", *names, script=CLIENT)
    commanding.answer()
    commanded_percent = harness.cpu_percent(processes[0], seconds)
    commanding.stop()
    figures = statistics()
    client = harness.Client("latency", "--steps", str(steps), "--namespace", names[-1])
    latencies_s = client.answer()["latencies_s"]
    client.stop()
    return Measured(ready_s, percent, memory_mb, rates_hz, commanded_percent, figures, latencies_s)


def rows_of(copies: int, seconds: float, steps: int) -> list[harness.Row]:
    """Return the figures of some arms in one world."""
    names = [f"/arm_{index}" for index in range(copies)] if copies > 1 else [""]
    what = f"{copies} arm{'s' if copies > 1 else ''}"
    with harness.fresh_domain():
        running = harness.Suite(f"copies:={copies}", "camera:=none", "controller_node:=false")
        try:
            found = measured(running, names, seconds, steps)
        finally:
            running.stop()
    p50, p99 = harness.percentiles(found.latencies_s, 50, 99)
    tick, pace = found.figures["tick"], found.figures["time"]
    return [
        harness.Row(
            f"{what}: lowest and highest rate of a /joint_states",
            f"{min(found.rates_hz):.1f}, {max(found.rates_hz):.1f} Hz",
            f"{RATE_HZ} Hz",
        ),
        harness.Row(
            f"{what}: command to first motion p50 / p99",
            f"{p50 * 1e3:.1f} / {p99 * 1e3:.1f} ms (n={steps})",
        ),
        harness.Row(
            f"{what}: processor of the simulation; of the state publishers",
            f"{found.percent[0]:.1f}; {found.percent[1]:.1f} % of a core",
            "100 % of a core",
        ),
        harness.Row(
            f"{what}, each commanded at 100 Hz: processor of the simulation",
            f"{found.commanded_percent:.1f} % of a core",
            "100 % of a core",
        ),
        harness.Row(
            f"{what}: memory of the simulation; of the state publishers",
            f"{found.memory_mb[0]:.0f}; {found.memory_mb[1]:.0f} MB",
        ),
        harness.Row(
            f"{what}: a tick of 10 ms takes; of it physics; lag of its start, now and greatest",
            f"{tick['whole (us)']}; {tick['physics (us)']} µs; "
            f"{pace['lag (ms)']}, {pace['greatest lag (ms)']} ms",
        ),
        harness.Row(f"{what}: `arm launch` until ready", f"{found.ready_s:.1f} s"),
    ]


def main() -> None:
    """Print the table."""
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("--copies", type=int, nargs="+", default=[1, 4, 16])
    parser.add_argument("--seconds", type=float, default=20.0)
    parser.add_argument("--steps", type=int, default=40)
    arguments = parser.parse_args()
    rows = []
    for copies in arguments.copies:
        rows += rows_of(copies, arguments.seconds, arguments.steps)
    harness.print_table("Several arms in one world, 100 Hz", rows)


if __name__ == "__main__":
    main()
