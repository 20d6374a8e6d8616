"""Steps a second of many copies with the servo law, beside MuJoCo's rollout of the bare model.

Both step the same model with contacts; the rollout's drives follow nothing. One pair after the
other, so that what else runs on the machine slows both; the ratio is the median of the pairs.
"""

import argparse
import os
import statistics
import time

import gymnasium
import harness
import mujoco
import numpy as np
from mujoco import rollout

import arm_sim.gym  # noqa: F401  registers the ids
from arm_gazebo.batch.choice import make_copies
from arm_sim import Simulation

COPIES = (1, 2, 16, 64)
STATE = mujoco.mjtState.mjSTATE_FULLPHYSICS
HELD_PERIODS = 4
"""Control periods of one action."""
CHANGES_EVERY = 12
"""Actions after which the goal changes, so that the drives never rest."""


def bare_steps(simulation: Simulation, copies: int, periods: int) -> float:
    """Return physics steps a second of `mujoco.rollout`."""
    physics = simulation.parts.physics
    model, steps = physics.model, periods * physics.timing.steps
    model.opt.disableflags &= ~int(mujoco.mjtDisableBit.mjDSBL_CONTACT)
    threads = min(copies, os.cpu_count() or 1)
    data = [mujoco.MjData(model) for _ in range(threads)]
    data[0].qpos[:] = physics.built.qpos
    start = np.empty(mujoco.mj_stateSize(model, STATE))
    mujoco.mj_getState(model, data[0], start, STATE)
    states, control = np.tile(start, (copies, 1)), np.zeros((copies, 1, model.nu))
    with rollout.Rollout(nthread=threads if copies > 1 else 0) as pool:
        pool.rollout(model, data, states, control, nstep=HELD_PERIODS)
        began = time.perf_counter()
        pool.rollout(model, data, states, control, nstep=steps)
        return copies * steps / (time.perf_counter() - began)


def driven_steps(simulation: Simulation, copies: int, periods: int) -> float:
    """Return physics steps a second of copies whose drives follow moving goals."""
    parts = simulation.parts
    batch = make_copies(parts.physics, parts.robot.hardware, copies)
    random = np.random.default_rng(0)
    actions = periods // HELD_PERIODS
    shape = (actions // CHANGES_EVERY + 1, copies, len(parts.physics.servo.joints))
    goals = random.uniform(-1.0, 1.0, shape)
    batch.advance(goals[0], HELD_PERIODS)
    began = time.perf_counter()
    for action in range(actions):
        batch.advance(goals[action // CHANGES_EVERY], HELD_PERIODS)
    steps = copies * actions * HELD_PERIODS * parts.physics.timing.steps
    return steps / (time.perf_counter() - began)


def env_steps(copies: int, actions: int) -> float:
    """Return actions a second of ArmReach with its observations and rewards."""
    options = {"simulation": {"arguments": {"camera": "none"}}}
    batch = gymnasium.make_vec("arm_sim/ArmReach-v0", num_envs=copies, **options)
    batch.reset(seed=0)
    taken = [batch.action_space.sample() for _ in range(10)]
    began = time.perf_counter()
    for index in range(actions):
        batch.step(taken[index % 10])
    done = copies * actions / (time.perf_counter() - began)
    batch.close()
    return done


def rows(robot: str, arguments: dict[str, str], pairs: int, periods: int) -> list[harness.Row]:
    """Return the figures of one robot."""
    found = []
    with Simulation(robot, arguments=arguments) as simulation:
        for copies in COPIES:
            each = max(100, periods // copies)
            measured = [
                (bare_steps(simulation, copies, each), driven_steps(simulation, copies, each))
                for _ in range(pairs)
            ]
            bare, driven = (statistics.median(one) for one in zip(*measured, strict=True))
            ratio = statistics.median(driven / bare for bare, driven in measured)
            found.append(
                harness.Row(
                    f"{robot}, copies {copies}: steps/s with drives; bare rollout; ratio",
                    f"{driven:,.0f}; {bare:,.0f}; {ratio:.2f}",
                    "ratio 0.5",
                )
            )
    return found


def main() -> None:
    """Print the table."""
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("--pairs", type=int, default=5, help="pairs of measurements (5)")
    parser.add_argument("--periods", type=int, default=2000, help="control periods in all (2000)")
    options = parser.parse_args()
    table = rows("arm", {"camera": "none"}, options.pairs, options.periods)
    table += rows("mycobot", {}, options.pairs, options.periods)
    rates = ", ".join(f"{env_steps(copies, 200):,.0f}" for copies in COPIES)
    table.append(harness.Row(f"ArmReach, copies {COPIES}: actions/s of 20 steps", rates, ""))
    harness.print_table("Learning: copies of the arm and of the myCobot among its things", table)


if __name__ == "__main__":
    main()
