"""What snapshots and resets take, and whether a thousand resets over ROS leave anything behind."""

import argparse
import time
from collections.abc import Callable
from pathlib import Path
from statistics import median

import harness
import numpy as np

from arm_gazebo.state.complete_state import CompleteState
from arm_sim import Simulation

RESETS_CLIENT = Path(__file__).with_name("resets_client.py")
REPEATS = 300
TICKS_BEFORE = 200
RESETS = 1000
TRAJECTORY = {
    "arm": ("joint_trajectory_controller", 4),
    "mycobot": ("arm_controller", 6),
}
RUNNING = (
    *("camera:=none", "controller_node:=false"),
    "spawn:=joint_state_broadcaster,joint_trajectory_controller",
)
CONTROLLERS = """\
controller_manager:
  ros__parameters:
    update_rate: {rate_hz}
    joint_state_broadcaster:
      type: joint_state_broadcaster/JointStateBroadcaster
    joint_trajectory_controller:
      type: joint_trajectory_controller/JointTrajectoryController
joint_trajectory_controller:
  ros__parameters:
    joints: [j0, j1, j2, j3]
    command_interfaces: [position]
    state_interfaces: [position, velocity]
"""


def timed_ms(action: Callable[[], object], repeats: int = REPEATS) -> float:
    """Return how long an action takes, the median."""
    taken = []
    for _ in range(repeats):
        start_s = time.perf_counter()
        action()
        taken.append((time.perf_counter() - start_s) * 1e3)
    return median(taken)


def moving(robot: str) -> Simulation:
    """Return a robot whose arm follows a long trajectory."""
    controller, joints = TRAJECTORY[robot]
    sim = Simulation(robot, spawn=["joint_state_broadcaster", controller])
    sim.controllers[controller].follow({"times_s": [1000.0], "positions": [[0.5] * joints]})
    for _ in range(TICKS_BEFORE):
        sim.step()
    return sim


def rows_of(robot: str) -> list[harness.Row]:
    """Return what saving, restoring and comparing take."""
    run = moving(robot).parts
    state: CompleteState = run.state
    saved = state.save()
    digest_us = timed_ms(state.digest, 3 * REPEATS) * 1e3
    tick_us = timed_ms(run.tick, 3 * REPEATS) * 1e3
    save_ms, restore_ms = timed_ms(state.save), timed_ms(lambda: state.restore(saved))
    reset_ms = timed_ms(lambda: state.reset(True))
    return [
        harness.Row(f"{robot}: save; restore; reset", f"{save_ms:.2f}; {restore_ms:.2f}; "
                    f"{reset_ms:.2f} ms", "one tick of 10 ms"),
        harness.Row(f"{robot}: a snapshot", f"{len(saved) / 1e3:.0f} kB"),
        harness.Row(f"{robot}: digest of a state; a tick", f"{digest_us:.1f}; {tick_us:.1f} us",
                    "20 to 30 us"),
    ]  # fmt: skip


def resets(count: int) -> list[harness.Row]:
    """Return what many resets over ROS take, and what they leave behind."""
    with harness.suite(*RUNNING, parameters=CONTROLLERS) as running:
        process = running.find("arm_gazebo_node")
        client = harness.Client(str(count), str(process.pid), script=RESETS_CLIENT)
        found = client.answer()
        client.stop()
    memory = np.polyfit(np.arange(len(found["memory_mb"])), found["memory_mb"], 1)[0]
    return [
        harness.Row(f"{count} resets over ROS: median; slowest",
                    f"{median(found['reset_ms']):.1f}; {max(found['reset_ms']):.1f} ms"),
        harness.Row("goals that were reset; goals in between that succeeded",
                    f"{found['aborted']}; {found['succeeded']} of {found['sent']}", "all"),
        harness.Row("memory: slope of a fit", f"{1e3 * memory / found['every']:.2f} kB a reset",
                    "0"),
        harness.Row("threads, first and last", f"{found['threads'][0]}, {found['threads'][-1]}",
                    "equal"),
        harness.Row("file descriptors, first and last",
                    f"{found['files'][0]}, {found['files'][-1]}", "equal"),
    ]  # fmt: skip


def main() -> None:
    """Print the tables."""
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("--resets", type=int, default=RESETS, help="number of resets over ROS")
    count = parser.parse_args().resets
    rows = [row for robot in TRAJECTORY for row in rows_of(robot)]
    harness.print_table("Snapshots and resets in the process", rows)
    harness.print_table("Resets over ROS, each with a goal under way", resets(count))


if __name__ == "__main__":
    main()
