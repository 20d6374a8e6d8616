"""Copies by MuJoCo Warp beside those by MuJoCo: how far apart, and how fast.

    python tests/benchmarks/gpu_copies.py --copies 4096            # on a GPU
    python tests/benchmarks/gpu_copies.py --device cpu --copies 4  # without one

Without a GPU, Warp compiles for some minutes first. Not part of run_all.py, because it needs the
extra `gpu`.
"""

import argparse
import time

import harness
import numpy as np

from arm_gazebo.batch.copies import CommandBounds, Copies
from arm_gazebo.batch.physics_batch import PhysicsBatch
from arm_gazebo.batch.warp_batch import GPU, WarpBatch
from arm_sim import Simulation

CHANGES_EVERY = 48


def run(batch: Copies, goals: np.ndarray, periods: int) -> tuple[np.ndarray, float]:
    """Return the positions after each period, shape (periods, copies, nq), and the seconds."""
    batch.advance(goals[0])
    batch.reset()
    found = []
    began = time.perf_counter()
    for period in range(periods):
        batch.advance(goals[period // CHANGES_EVERY])
        found.append(batch.qpos.copy())
    return np.array(found), time.perf_counter() - began


def main() -> None:
    """Print the table."""
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("--device", default=GPU, help=f"Warp's name of the device ({GPU})")
    parser.add_argument("--copies", type=int, default=4096, help="number of copies (4096)")
    parser.add_argument("--periods", type=int, default=100, help="control periods (100)")
    options = parser.parse_args()
    with Simulation("arm", arguments={"camera": "none"}) as simulation:
        physics, hardware = simulation.parts.physics, simulation.parts.robot.hardware
        bounds = CommandBounds(physics, hardware)
        shape = (options.periods // CHANGES_EVERY + 1, options.copies, len(physics.servo.joints))
        goals = np.random.default_rng(0).uniform(-1.0, 1.0, shape)
        there, there_s = run(
            WarpBatch(physics, bounds, options.copies, options.device), goals, options.periods
        )
        here, here_s = run(PhysicsBatch(physics, bounds, options.copies), goals, options.periods)
    steps = options.copies * options.periods * physics.timing.steps
    apart = np.abs(there - here).max(axis=(0, 1)).max() * 1e3
    harness.print_table(
        f"Copies on Warp's device {options.device}, {options.copies} of them",
        [
            harness.Row("largest difference of a joint from MuJoCo's", f"{apart:.3f} mrad", "1"),
            harness.Row("steps/s there; here", f"{steps / there_s:,.0f}; {steps / here_s:,.0f}"),
        ],
    )


if __name__ == "__main__":
    main()
