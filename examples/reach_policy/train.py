"""Train the policy by CMA-ES: generations of candidates, each tried in copies of the arm.

    python train.py

It takes 40 s on two cores that do nothing else. It writes the weights, and the curve as a table and
a picture.
"""

import argparse
import time
from dataclasses import replace
from pathlib import Path

import cma
import numpy as np
from curve import Generation, draw, write
from policy import WEIGHTS, Array, act, save

from arm_sim.gym import BatchEnv, Task
from arm_sim.gym.reach import TOLERANCE_M, reach_task

FOLDER = Path(__file__).parent
CANDIDATES, GOALS = 24, 8
EPISODE_STEPS, EPISODES = 30, 2
"""The second episode goes on where the first one ends, so that the policy knows other starts."""
END_STEPS, END_SHARE = 5, 3.0
"""The last steps count more: the gripper is to stay at the goal."""
FIRST_SPREAD = 0.3


def environment(copies: int) -> BatchEnv:
    """Return copies of the task in which reaching a goal does not end an episode."""
    task: Task = replace(reach_task(), terminated=Task().terminated)
    return BatchEnv(
        copies,
        "arm",
        task,
        actions="step",
        restart=False,
        max_episode_steps=EPISODE_STEPS,
        simulation={"arguments": {"camera": "none"}},
    )


def distances(env: BatchEnv, weights: Array, seeds: list[int]) -> Array:
    """Return the distances to the goals after each step, shape (episodes, steps, copies).

    Args:
        env: the copies.
        weights: weights of each copy, shape (copies, 84) or (84,).
        seeds: seed of the goals of each copy.
    """
    seen, _ = env.reset(seed=list[int | None](seeds))
    found = np.zeros((EPISODES * EPISODE_STEPS, env.num_envs))
    for step in range(len(found)):
        actions = act(weights, seen["position"], seen["error"])
        seen, rewards, *_ = env.step(actions.astype(np.float32))
        found[step] = -rewards
    return found.reshape(EPISODES, EPISODE_STEPS, env.num_envs)


def costs(found: Array) -> Array:
    """Return the cost of each candidate; the copies of a candidate are consecutive."""
    late = found[:, -END_STEPS:].mean(axis=(0, 1))
    return (found.mean(axis=(0, 1)) + END_SHARE * late).reshape(CANDIDATES, GOALS).mean(axis=1)


def train(generations: int, seed: int) -> tuple[Array, list[Generation]]:
    """Return the weights after some generations, and the curve."""
    env = environment(CANDIDATES * GOALS)
    options = {"popsize": CANDIDATES, "seed": seed + 1, "verbose": -9}
    search = cma.CMAEvolutionStrategy(np.zeros(WEIGHTS), FIRST_SPREAD, options)
    curve: list[Generation] = []
    began = time.monotonic()
    for number in range(generations):
        candidates = np.array(search.ask())
        seeds = [1000 * number + goal + seed for goal in range(GOALS)] * CANDIDATES
        found = distances(env, np.repeat(candidates, GOALS, axis=0), seeds)
        each = costs(found)
        search.tell(candidates, each.tolist())
        reached = float((found[:, -1] <= TOLERANCE_M).mean())
        curve.append(Generation(time.monotonic() - began, float(np.median(each)), reached))
        print(f"{number + 1}: {curve[-1]}", flush=True)
    env.close()
    return np.array(search.result.xfavorite), curve


def share_reached(weights: Array, copies: int = 100) -> float:
    """Return the fraction of new goals, not used in the training, that the policy reaches."""
    env = environment(copies)
    found = distances(env, weights, [10**6 + goal for goal in range(copies)])
    env.close()
    return float((found[:, -1] <= TOLERANCE_M).mean())


def main() -> None:
    """Train, and write the weights and the curve."""
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("--generations", type=int, default=80, help="generations (80)")
    parser.add_argument("--seed", type=int, default=0, help="seed of candidates and goals (0)")
    parser.add_argument("--output", type=Path, default=FOLDER, help="folder (that of this file)")
    options = parser.parse_args()
    weights, curve = train(options.generations, options.seed)
    save(weights, options.output / "policy.json")
    write(curve, options.output / "curve.csv")
    draw(curve, options.output / "curve.svg")
    print(f"reaches {share_reached(weights):.1%} of 200 other goals")


if __name__ == "__main__":
    main()
