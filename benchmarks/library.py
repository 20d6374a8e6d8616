"""The simulation as a library: its import, its first step, and a control period beside the node's.

The node's loop is the node's `ControlLoop` with the same tick, stepped without pacing and without
ROS. Both run in pairs in one process, one after the other in turns.
"""

import argparse
import json
import statistics
import subprocess
import sys
import time
from collections.abc import Callable, Sequence
from pathlib import Path

import harness

from arm_control.loop.control_loop import ControlLoop
from arm_control.loop.pacer import Pacer
from arm_sim import Simulation

START = """
import json, time
before = time.perf_counter()
from arm_sim import Simulation
imported = time.perf_counter()
sim = Simulation("arm")
sim.step()
stepped = time.perf_counter()
print(json.dumps((imported - before, stepped - imported)))
"""
POSE = [1.0, 0.5, 0.1, 0.5]


def start_s() -> tuple[float, float]:
    """Return how long the import takes in a new process, and the first step after it."""
    done = subprocess.run([sys.executable, "-c", START], capture_output=True, check=True)
    imported_s, stepped_s = json.loads(done.stdout)
    return imported_s, stepped_s


class NodeLoop:
    """The node's loop and tick, with the same controllers, without ROS."""

    def __init__(self, robot: str) -> None:
        self.sim = Simulation(robot)
        self._loop = ControlLoop(self.sim.parts.tick, Pacer(self.sim.period_s))
        self._loop.start(paused=True)

    def run(self, ticks: int) -> None:
        """Run ticks without pacing, and wait for the last one."""
        self._loop.step(ticks).result()

    def close(self) -> None:
        """End the loop."""
        self._loop.stop()
        self._loop.join()
        self.sim.close()


def cost_us(run: Callable[[int], None], ticks: int) -> float:
    """Return the wall time of a tick."""
    before = time.perf_counter()
    run(ticks)
    return (time.perf_counter() - before) / ticks * 1e6


def tick_costs(robot: str, ticks: int, rounds: int) -> list[tuple[float, float, float]]:
    """Return the cost of a tick in us in each round: the node's loop, `run`, and `step`."""
    node = NodeLoop(robot)
    with Simulation(robot) as sim:

        def step(count: int) -> None:
            for _ in range(count):
                sim.step()

        ways = (node.run, lambda count: sim.run(count * sim.period_s), step)
        for way in ways:
            way(ticks)
        costs = [tuple(cost_us(way, ticks) for way in ways) for _ in range(rounds)]
    node.close()
    return [(one, two, three) for one, two, three in costs]


def times_ms(calls: int) -> dict[str, float]:
    """Return how long other calls take, in ms: the median of some."""

    def median(call: Callable[[], object]) -> float:
        costs = []
        for _ in range(calls):
            sim.step()
            before = time.perf_counter()
            call()
            costs.append((time.perf_counter() - before) * 1e3)
        return statistics.median(costs)

    with Simulation("arm", world="objects") as sim:
        sim["position_controller"].command(POSE)
        here = sim.save()
        camera = sim.camera("videocamera")
        camera.image()
        return {
            "save": median(sim.save),
            "restore": median(lambda: sim.restore(here)),
            "reset": median(sim.reset),
            "an image of 320x240": median(camera.image),
            "contacts": median(sim.contacts),
        }


def seconds(values: Sequence[float]) -> str:
    """Return the median of some times."""
    return f"{statistics.median(values):.2f} s"


def main() -> None:
    """Print the table."""
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("--starts", type=int, default=9)
    parser.add_argument("--rounds", type=int, default=15)
    parser.add_argument("--ticks", type=int, default=2000)
    arguments = parser.parse_args()
    imports, firsts = zip(*(start_s() for _ in range(arguments.starts)), strict=True)
    rows = [
        harness.Row(
            "`from arm_sim import Simulation`", f"{statistics.median(imports):.2f} s", "0.4 s"
        ),
        harness.Row("then the arm's first step", f"{statistics.median(firsts):.2f} s", "0.3 s"),
    ]
    for robot in ("arm", "mycobot"):
        costs = tick_costs(robot, arguments.ticks, arguments.rounds)
        node, run, step = (statistics.median(column) for column in zip(*costs, strict=True))
        by_run = statistics.median(cost[1] / cost[0] for cost in costs)
        by_step = statistics.median(cost[2] / cost[0] for cost in costs)
        rows += [
            harness.Row(f"{robot}: a tick of the node's loop without ROS", f"{node:.0f} us"),
            harness.Row(f"{robot}: a tick of `run`; ratio", f"{run:.0f} us; {by_run:.2f}", "1.1"),
            harness.Row(
                f"{robot}: a tick of `step`; ratio", f"{step:.0f} us; {by_step:.2f}", "1.1"
            ),
        ]
    rows += [harness.Row(what, f"{cost:.2f} ms") for what, cost in times_ms(200).items()]
    print(harness.machine())
    harness.print_table(Path(__file__).stem.capitalize(), rows)


if __name__ == "__main__":
    main()
