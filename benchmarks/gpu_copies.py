"""Copies by MuJoCo Warp beside those by MuJoCo: how far apart, and how fast.

    python benchmarks/gpu_copies.py                                # on a GPU
    python benchmarks/gpu_copies.py --device cpu --copies 4        # without one

All drives follow moving goals. Without a GPU, Warp compiles for some minutes first. Not part of
run_all.py, because it needs the extra `gpu`.
"""

import argparse
import os
import statistics
import time

import gymnasium
import harness
import numpy as np

import arm_sim.gym  # noqa: F401  registers the ids
from arm_gazebo.batch.choice import HOST, make_copies
from arm_gazebo.batch.copies import Copies
from arm_sim import Simulation

ROBOTS = {"arm": {"camera": "none"}, "mycobot": {}}
TASKS = {"arm": "arm_sim/ArmReach-v0", "mycobot": "arm_sim/ArmPick-v0"}
COPIES = (1, 64, 1024, 4096, 16384)
HELD_PERIODS = 4
"""Control periods of one action."""
CHANGES_EVERY = 12
"""Actions after which the goals change, so that the drives never rest."""
ENVIRONMENT_ACTIONS = 20
NEAR_MRAD = 0.1
"""Copies that touch something go their own way: MuJoCo Warp finds contacts by another algorithm."""


def run(batch: Copies, goals: np.ndarray, actions: int) -> tuple[np.ndarray, float]:
    """Return the positions after each action, shape (actions, copies, nq), and the seconds."""
    batch.advance(goals[0], HELD_PERIODS)
    batch.reset()
    found = []
    began = time.perf_counter()
    for action in range(actions):
        batch.advance(goals[action // CHANGES_EVERY], HELD_PERIODS)
        found.append(batch.qpos.copy())
    return np.array(found), time.perf_counter() - began


def compared(simulation: Simulation, device: str, copies: int, actions: int) -> list[harness.Row]:
    """Return how far apart the copies on the device and on the host are, and how fast."""
    parts = simulation.parts
    joints = parts.physics.servo.joints
    shape = (actions // CHANGES_EVERY + 1, copies, len(joints))
    goals = np.random.default_rng(0).uniform(-1.0, 1.0, shape)
    (there, there_s), (here, here_s) = (
        run(make_copies(parts.physics, parts.robot.hardware, copies, device=each), goals, actions)
        for each in (device, HOST)
    )
    addresses = [joint.qpos_address for joint in joints]
    apart = np.abs(there - here)[:, :, addresses].max(axis=(0, 2)) * 1e3
    steps = copies * actions * HELD_PERIODS * parts.physics.timing.steps
    return [
        harness.Row(
            f"{copies}: largest difference of a joint in the middle copy; "
            f"copies within {NEAR_MRAD} mrad",
            f"{statistics.median(apart):.4f} mrad; {100.0 * (apart < NEAR_MRAD).mean():.1f} %",
        ),
        harness.Row(
            f"{copies}: steps/s there; here; ratio",
            f"{steps / there_s:,.0f}; {steps / here_s:,.0f}; {here_s / there_s:.2f}",
        ),
    ]


def actions_per_s(name: str, device: str, copies: int) -> float:
    """Return actions a second of an environment, with observations, rewards and restarts."""
    batch = gymnasium.make_vec(name, num_envs=copies, device=device)
    batch.reset(seed=0)
    actions = batch.action_space.sample()
    batch.step(actions)
    began = time.perf_counter()
    for _ in range(ENVIRONMENT_ACTIONS):
        batch.step(actions)
    done = copies * ENVIRONMENT_ACTIONS / (time.perf_counter() - began)
    batch.close()
    return done


def main() -> None:
    """Print a table for each robot."""
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("--device", default="cuda", help="Warp's name of the device (cuda)")
    parser.add_argument(
        "--robots", nargs="+", choices=ROBOTS, default=[*ROBOTS], help="robots (all)"
    )
    parser.add_argument(
        "--copies", nargs="+", type=int, default=COPIES, help="numbers of copies (1 to 16384)"
    )
    parser.add_argument("--actions", type=int, default=25, help="actions of 4 periods (25)")
    options = parser.parse_args()
    for robot in options.robots:
        rows = []
        with Simulation(robot, arguments=ROBOTS[robot]) as simulation:
            for copies in options.copies:
                rows += compared(simulation, options.device, copies, options.actions)
        for copies in options.copies:
            rates = [actions_per_s(TASKS[robot], each, copies) for each in (options.device, HOST)]
            there, here = (f"{rate:,.0f}" for rate in rates)
            rows.append(
                harness.Row(f"{copies}: {TASKS[robot]}, actions/s there; here", f"{there}; {here}")
            )
        harness.print_table(
            f"Copies of {robot} on Warp's device {options.device}; here {os.cpu_count()} cores",
            rows,
        )


if __name__ == "__main__":
    main()
