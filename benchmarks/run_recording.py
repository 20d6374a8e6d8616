"""What recording a run costs, and whether a long run repeats to the last bit.

    python benchmarks/run_recording.py [--seconds 60] [--replays 10]

The cost is that of a control period as fast as possible: two simulations of the same robot take
turns, one of them recorded. Processor time of the loop's thread depends on other load the least;
`chrt -f 50` keeps that off. Then a node at 100 Hz records by turns, and says what its ticks cost.
The run is the myCobot with goals, cancellations, its gripper and
things that come and go; it is replayed while other processes keep both cores busy.
"""

import argparse
import multiprocessing
import statistics
import tempfile
import time
from pathlib import Path

import harness
import numpy as np
from harness import Row

from arm_gazebo.recording.replay import Replay
from arm_gazebo.recording.run_file import RunFile
from arm_sim import Simulation

TURN = 50
"""Control periods in a row of each of the two simulations."""
TURNS = 300
NODE_TURNS = 8
CLIENT = Path(__file__).with_name("run_recording_client.py")
CAN = """<mujoco><worldbody><body><freejoint/>
<geom type="cylinder" size="0.03 0.05" mass="0.1"/></body></worldbody></mujoco>"""


def turn_s(sim: Simulation) -> float:
    """Return the processor time of some control periods."""
    began_s = time.thread_time()
    for _ in range(TURN):
        sim.step()
    return time.thread_time() - began_s


def cost_rows(robot: str, world: str, folder: Path) -> list[Row]:
    """Compare a control period with and without a recording, in turns."""
    path = folder / f"{robot}_{world}.run"
    with (
        Simulation(robot, world=world) as plain,
        Simulation(robot, world=world, record=path) as rec,
    ):
        turn_s(plain), turn_s(rec)
        pairs = [(turn_s(plain), turn_s(rec)) for _ in range(TURNS)]
    plain_us = statistics.median(p for p, _ in pairs) / TURN * 1e6
    ratio = statistics.median(r / p for p, r in pairs)
    size = path.stat().st_size / ((TURNS + 1) * TURN)
    what = f"a control period of {robot} in {world}, as fast as possible"
    return [
        Row(what, f"{plain_us:.0f} us; recorded {ratio:.3f} times as long", "1.03"),
        Row("the file, for each control period", f"{size:.0f} bytes"),
    ]


def node_row(folder: Path) -> Row:
    """Compare the ticks of a node at 100 Hz with and without a recording, in turns."""
    with harness.suite("camera:=none") as _:
        client = harness.Client(str(folder), str(NODE_TURNS), script=CLIENT)
        seen = client.answer()
        client.stop()
    plain, recorded = np.median(seen["plain"], axis=1), np.median(seen["recorded"], axis=1)
    return Row(
        f"a tick of the arm's node at 100 Hz, wall time, medians of {NODE_TURNS} turns",
        f"{np.median(plain):.0f} us; recorded {np.median(recorded / plain):.3f} times as long",
        "1.03",
    )


def long_run(path: Path, seconds: float) -> int:
    """Record a run of the myCobot; return the number of its control periods."""
    random = np.random.default_rng(0)
    periods = 0
    with Simulation("mycobot", record=path) as sim:
        number = 0
        while sim.time_s < seconds:
            target = random.uniform(-0.6, 0.6, 6)
            goal = sim["arm_controller"].follow({"positions": [target], "times_s": [0.8]})
            sim["gripper_action_controller"].grip(float(random.uniform(-0.6, 0.1)))
            sim.run(float(random.uniform(0.2, 1.0)))
            if random.random() < 0.2:
                goal.cancel()
            if random.random() < 0.3:
                number += 1
                name = sim.spawn(
                    CAN, name=f"can{number}", pose=(*random.uniform(-0.4, 0.4, 2), 0.5)
                )
                sim.run(0.2)
                if random.random() < 0.5:
                    sim.delete(name)
        periods = round(sim.time_s / sim.period_s)
    return periods


def burn(until_s: float) -> None:
    """Keep a core busy."""
    while time.time() < until_s:
        sum(range(10000))


def replay_rows(folder: Path, seconds: float, replays: int) -> list[Row]:
    """Record a long run, and replay it under load."""
    path = folder / "long.run"
    periods = long_run(path, seconds)
    equal, times_s = 0, []
    load = [multiprocessing.Process(target=burn, args=(time.time() + 600,)) for _ in range(2)]
    for process in load:
        process.start()
    try:
        for _ in range(replays):
            began_s = time.perf_counter()
            result = Replay(RunFile(path)).run()
            times_s.append(time.perf_counter() - began_s)
            equal += result.difference is None and result.periods == periods
            if result.difference is not None:
                print(result.difference)
    finally:
        for process in load:
            process.terminate()
    return [
        Row(
            f"replays of {seconds:g} s of the myCobot that are equal to the last bit, under load",
            f"{equal} of {replays}",
            f"{replays} of {replays}",
        ),
        Row("one replay", f"{statistics.median(times_s):.2f} s"),
        Row("its file", f"{path.stat().st_size / 1e6:.1f} MB"),
    ]


def main() -> None:
    """Print the table."""
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("--seconds", type=float, default=60.0)
    parser.add_argument("--replays", type=int, default=10)
    options = parser.parse_args()
    with tempfile.TemporaryDirectory() as name:
        folder = Path(name)
        rows = [
            *cost_rows("arm", "empty", folder),
            *cost_rows("mycobot", "pick_and_place_demo", folder),
            node_row(folder),
            *replay_rows(folder, options.seconds, options.replays),
        ]
    harness.print_table("Recorded runs", rows)


if __name__ == "__main__":
    main()
