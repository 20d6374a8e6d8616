"""Train the policy by behaviour cloning: an expert picks, and a network learns its commands.

    python imitate.py

It writes the weights, and the curve as a table and a picture.
"""

import argparse
import time
from collections.abc import Iterator
from dataclasses import dataclass
from pathlib import Path

import numpy as np
from numpy.typing import NDArray
from pick_curve import Epoch, draw, write
from pick_policy import (
    CARRIED_OUT,
    CHUNK,
    INPUTS,
    JOINTS,
    OUTPUTS,
    Array,
    Policy,
    inputs,
    layers,
    save,
)

from arm_controller.pick_plan import PlanError
from arm_planning.errors import PlanningError
from arm_sim.demonstrations.pick_scene import (
    FARTHEST_M,
    MOST_ASIDE,
    MOST_CLOSED,
    MOST_OPEN,
    NEAREST_M,
    START_RAD,
    START_S,
)
from arm_sim.gym import ArmPick
from arm_sim.gym.arm_env import ArmEnv
from arm_sim.gym.pick import OBJECT, STANDING_M

Floats = NDArray[np.float32]

FOLDER = Path(__file__).parent
STEPS = 220
"""Actions of an episode; an expert's pick takes 150 to 200."""
MOST_PUSH_RAD, PUSH_STEPS, PUSH_KEPT = 0.04, 25, 0.75
"""From time to time the expert is pushed off its way, so that the policy learns the way back: how
far, in the worst episodes, how often, and what is left of a push after each action."""
HIDDEN, BATCH, FASTEST, SLOWEST = 128, 512, 2e-3, 2e-5
JUDGED_EVERY, TRIED, FIRST_TRIED_SEED = 5, 10, 10**6
"""Epochs between two points of the curve, and the picks by which a policy is judged there."""


@dataclass(frozen=True)
class Rows:
    """What was demonstrated: what the network sees, shape (m, 9), and says, shape (m, 70)."""

    seen: Array
    said: Array


def environment(expert: bool) -> ArmPick:
    """Return the pick, with the arm's start and the cylinder's place at random."""
    return ArmPick(actions="position", expert=expert, vary=vary)


def vary(env: ArmEnv, random: np.random.Generator) -> None:
    """Put the cylinder somewhere in reach, and the arm near its home position."""
    distance, aside = random.uniform(NEAREST_M, FARTHEST_M), random.uniform(-MOST_ASIDE, MOST_ASIDE)
    env.simulation.place(OBJECT, (distance * np.cos(aside), distance * np.sin(aside), STANDING_M))
    arm = random.uniform(-START_RAD, START_RAD, len(JOINTS) - 1)
    env.move(np.append(arm, random.uniform(MOST_CLOSED, MOST_OPEN)), START_S)


def measured(env: ArmEnv) -> Array:
    """Return the arm's positions and the gripper's command, shape (7,)."""
    return np.append(env.position[:-1], env.command[-1])


def demonstrate(env: ArmPick, seed: int) -> Rows | None:
    """Return the rows of one pick; None if the expert does not succeed."""
    random = np.random.default_rng(seed)
    try:
        _, info = env.reset(seed=seed)
    except (PlanError, PlanningError):
        return None
    middle, half = (env.upper + env.lower) / 2.0, (env.upper - env.lower) / 2.0
    spread = np.append(np.full(len(JOINTS) - 1, random.uniform(0.0, MOST_PUSH_RAD)), 0.0)
    push, seen, said = np.zeros(len(JOINTS)), list[Array](), list[Array]()
    for step in range(STEPS):
        push = random.normal(0.0, spread) if step % PUSH_STEPS == 0 else PUSH_KEPT * push
        seen.append(np.concatenate([measured(env), env.point(OBJECT)[:2]]))
        said.append(middle + half * info["expert_action"])
        action = info["expert_action"] + push / half
        _, _, terminated, truncated, info = env.step(action.astype(np.float32))
        if terminated or truncated:
            break
    if not info["is_success"]:
        return None
    return _chunks(np.array(seen), np.array(said), float(env.goal["lift"][0]))


def _chunks(seen: Array, said: Array, lift: float) -> Rows:
    """Return each state with the changes that the next commands make; the last one is repeated."""
    joints, place = seen[:, : len(JOINTS)], seen[:, len(JOINTS) :]
    ahead = np.minimum(np.arange(len(said))[:, None] + np.arange(CHUNK), len(said) - 1)
    changes = said[ahead] - joints[:, None]
    return Rows(inputs(joints, place, lift), changes.reshape(len(said), -1))


def demonstrations(picks: int, seed: int) -> Rows:
    """Return the rows of the first picks, from a seed on, in which the expert succeeds."""
    env, found = environment(expert=True), list[Rows]()
    while len(found) < picks:
        shown = demonstrate(env, seed)
        found += [] if shown is None else [shown]
        seed += 1
    env.close()
    return Rows(
        np.concatenate([one.seen for one in found]), np.concatenate([one.said for one in found])
    )


class Adam:
    """Learns the weights of a network from batches, by Adam.

    Attributes:
        weights: see `Policy`, in 32 bits.
    """

    def __init__(self, random: np.random.Generator) -> None:
        sizes = ((INPUTS, HIDDEN), (HIDDEN, HIDDEN), (HIDDEN, OUTPUTS))
        self.weights: tuple[Floats, ...] = tuple(
            np.append(
                random.normal(0.0, fan_in**-0.5, (fan_in, to)), np.zeros((1, to)), axis=0
            ).astype(np.float32)
            for fan_in, to in sizes
        )
        self._means = [np.zeros_like(layer) for layer in self.weights]
        self._squares = [np.zeros_like(layer) for layer in self.weights]
        self._steps = 0

    def learn(self, x: Floats, wanted: Floats, rate: float) -> float:
        """Learn a batch; return the mean square of the errors before."""
        outputs = layers(self.weights, x)
        wrong = outputs.pop() - wanted
        back = 2.0 * wrong / wrong.size
        self._steps += 1
        rate *= (1.0 - 0.999**self._steps) ** 0.5 / (1.0 - 0.9**self._steps)
        for layer, mean, square in zip(
            self.weights[::-1], self._means[::-1], self._squares[::-1], strict=True
        ):
            before = outputs.pop()
            slope = np.append(before.T @ back, back.sum(axis=0, keepdims=True), axis=0)
            back = (back @ layer[:-1].T) * (1.0 - before**2)
            mean += 0.1 * (slope - mean)
            square += 0.001 * (slope**2 - square)
            layer -= rate * mean / (np.sqrt(square) + 1e-8)
        return float((wrong**2).mean())


def clone(rows: Rows, epochs: int, seed: int) -> Iterator[tuple[Policy, float]]:
    """Yield the policy after each epoch, with the mean square of its scaled errors."""
    random = np.random.default_rng(seed)
    adam = Adam(random)
    seen, said = (
        np.stack([one.mean(axis=0), one.std(axis=0) + 1e-6]) for one in (rows.seen, rows.said)
    )
    x = ((rows.seen - seen[0]) / seen[1]).astype(np.float32)
    wanted = ((rows.said - said[0]) / said[1]).astype(np.float32)
    for epoch in range(epochs):
        batches = np.array_split(random.permutation(len(x)), max(1, len(x) // BATCH))
        errors = list[float]()
        for number, batch in enumerate(batches):
            done = (epoch + number / len(batches)) / epochs
            rate = SLOWEST + (FASTEST - SLOWEST) * 0.5 * (1.0 + float(np.cos(np.pi * done)))
            errors.append(adam.learn(x[batch], wanted[batch], rate))
        weights = tuple(layer.astype(np.float64) for layer in adam.weights)
        yield Policy(weights, seen, said), float(np.mean(errors))


def share_lifted(env: ArmPick, policy: Policy, picks: int = TRIED) -> float:
    """Return the fraction of new picks in which the policy lifts the cylinder."""
    middle, half = (env.upper + env.lower) / 2.0, (env.upper - env.lower) / 2.0
    lifted = 0
    for seed in range(FIRST_TRIED_SEED, FIRST_TRIED_SEED + picks):
        env.reset(seed=seed)
        lift, ahead = float(env.goal["lift"][0]), np.empty((0, len(JOINTS)))
        for step in range(STEPS):
            if step % CARRIED_OUT == 0:
                ahead = policy.commands(measured(env), env.point(OBJECT)[:2], lift)
            action = (ahead[step % CARRIED_OUT] - middle) / half
            if env.step(action.astype(np.float32))[2]:
                lifted += 1
                break
    return lifted / picks


def main() -> None:
    """Train, and write the weights and the curve."""
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("--picks", type=int, default=100, help="demonstrations (100)")
    parser.add_argument("--epochs", type=int, default=40, help="epochs (40)")
    parser.add_argument("--seed", type=int, default=0, help="seed of scenes and weights (0)")
    parser.add_argument("--output", type=Path, default=FOLDER, help="folder (that of this file)")
    options = parser.parse_args()
    began = time.monotonic()
    rows = demonstrations(options.picks, options.seed)
    print(f"{len(rows.seen)} rows in {time.monotonic() - began:.0f} s", flush=True)
    env, curve = environment(expert=False), list[Epoch]()
    policies = list[Policy]()
    for policy, error in clone(rows, options.epochs, options.seed):
        policies.append(policy)
        if len(policies) % JUDGED_EVERY == 0:
            curve.append(Epoch(len(policies), error, share_lifted(env, policy)))
            print(curve[-1], flush=True)
    save(policies[-1], options.output / "policy.npz")
    write(curve, options.output / "curve.csv")
    draw(curve, options.output / "curve.svg")
    print(f"lifts the cylinder in {share_lifted(env, policies[-1], 100):.0%} of 100 picks")


if __name__ == "__main__":
    main()
