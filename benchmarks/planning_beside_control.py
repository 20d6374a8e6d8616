"""Rate of the control loop while move_group plans without pause.

The myCobot runs with `planning:=true` at 100 and at 500 Hz. A client keeps two requests to plan
open, so that move_group is never idle; with and without the client in turns. The rate is simulated
over wall time, from /clock. A tick is late by how much longer after the last one it arrives than
one period; a client that is late itself counts, too.

    python benchmarks/planning_beside_control.py

A user without the right to SCHED_FIFO has the loop of the rows "ordinary": `thread_priority: 0`.
"""

import argparse
import contextlib
import os
import tempfile
import time
from collections.abc import Iterator
from pathlib import Path

import harness
import numpy as np

ROBOTS = Path(__file__).parents[1] / "robots"
MODEL = ROBOTS / "mycobot_description/urdf/robots/mycobot_280.urdf.xacro"
CONTROLLERS = ROBOTS / "mycobot_moveit_config/config/mycobot_280/ros2_controllers_template.yaml"
WATCHER = Path(__file__).with_name("busy_client.py")
PLANNER = Path(__file__).with_name("planning_client.py")
RATES_HZ = (100, 500)
SETTLED_S = 2.0
"""The loop chooses its priority after a second."""


@contextlib.contextmanager
def robot(rate_hz: int, priority: int | None) -> Iterator[harness.Suite]:
    """Run the robot with move_group; None: the loop's usual priority."""
    text = CONTROLLERS.read_text()
    given = f"update_rate: {rate_hz}"
    if priority is not None:
        given += f"\n    thread_priority: {priority}"
    with harness.fresh_domain(), tempfile.TemporaryDirectory() as folder:
        file = Path(folder) / "controllers.yaml"
        file.write_text(text.replace("update_rate: 100", given))
        suite = harness.Suite(
            *("arm_gazebo", "sim.launch.py", f"model:={MODEL}", f"controllers:={file}"),
            *("spawn:=joint_state_broadcaster,arm_controller", "planning:=true"),
        )
        try:
            suite.wait_until_ready()
            time.sleep(SETTLED_S)
            yield suite
        finally:
            suite.stop()


def watched(seconds: float) -> tuple[float, float]:
    """Return simulated over wall time, and the 99th percentile of the lateness in ms."""
    watcher = harness.Client("watch", "--seconds", str(seconds), script=WATCHER)
    watcher.answer()
    ticks = np.array(watcher.answer()["ticks"])
    watcher.stop()
    wall, simulated = ticks[-1] - ticks[0]
    late = np.diff(ticks[:, 0]) - np.diff(ticks[:, 1])
    return float(simulated / wall), harness.percentiles(late * 1e3, 99)[0]


def measured(rate_hz: int, priority: int | None, seconds: float, turns: int) -> list[harness.Row]:
    """Return the rows of one robot: medians without plans, and with them."""
    found: dict[bool, list[tuple[float, float, float]]] = {False: [], True: []}
    codes: set[int] = set()
    answers = 0
    with robot(rate_hz, priority) as suite:
        process = suite.find("move_group")
        for plans in (False, True) * turns:
            if plans:
                client = harness.Client(str(seconds + 2.0), script=PLANNER)
                client.answer()
            before = process.cpu_times()
            rate, late_ms = watched(seconds)
            after = process.cpu_times()
            used_s = after.user + after.system - before.user - before.system
            found[plans].append((100 * rate, late_ms, 100 * used_s / seconds))
            if plans:
                said = client.answer()
                client.stop()
                codes.update(said["codes"])
                answers += said["answers"]
    if codes != {1}:
        raise SystemExit(f"plans failed: {sorted(codes)}")
    title = f"{rate_hz} Hz" + ("" if priority is None else ", ordinary priority")
    rows = []
    for plans, values in found.items():
        rate, late_ms, share = np.median(values, axis=0)
        rows.append(
            harness.Row(
                f"{title}, {f'{answers} plans' if plans else 'no plans'}: rate; lateness p99; "
                "processor of move_group",
                f"{rate:.2f} %; {late_ms:.1f} ms; {share:.0f} % of a core (n={turns})",
                "99 %" if plans and priority is None else "",
            )
        )
    return rows


def main() -> None:
    parser = argparse.ArgumentParser(description=__doc__.split("\n", 1)[0])
    parser.add_argument("--seconds", type=float, default=8.0, help="of each measurement")
    parser.add_argument("--turns", type=int, default=3)
    options = parser.parse_args()
    rows = []
    for rate_hz in RATES_HZ:
        for priority in (None, 0):
            rows += measured(rate_hz, priority, options.seconds, options.turns)
    load = os.getloadavg()[1]
    harness.print_table(f"The control loop beside planning, at a load of {load:.0f}", rows)


if __name__ == "__main__":
    main()
