"""The task of lifting the cylinder that stands in front of the myCobot."""

from collections.abc import Mapping
from typing import Any

import numpy as np

from arm_sim.gym.arm_env import ArmEnv
from arm_sim.gym.batch_env import BatchEnv
from arm_sim.gym.pick_expert import pick_expert
from arm_sim.gym.task import (
    JOINT_POSITIONS,
    JOINT_VELOCITIES,
    Array,
    Flags,
    Observation,
    Scene,
    Task,
)

WORLD = "pick"
"""The world of the launch without what the arm does not reach."""
OBJECT = "red_cylinder"
FINGERS = ("gripper_left1", "gripper_right1")
STANDING_M = 0.175
"""Height of the cylinder's middle while it stands on the floor."""
LOWEST_LIFT_M, HIGHEST_LIFT_M = 0.04, 0.08
REWARD_PER_M = 20.0
"""Reward for each metre of height, besides 1 for each metre closer to the cylinder."""


def pick_task() -> Task:
    """Return the task of gripping the cylinder and lifting it to a height.

    Observations are the joints' positions and velocities, the cylinder's middle `object`, the
    vector `reach` to it from the midpoint of the fingers, and the height `rise` by which it must
    still be lifted, in rad, m and s. The reward is minus the length of that vector, and 20 for each
    metre that the cylinder is above its place, up to the height. An episode ends when it is that
    high.
    """

    def reach(scene: Scene) -> Array:
        left, right = (scene.point(finger) for finger in FINGERS)
        return scene.point(OBJECT) - 0.5 * (left + right)

    def lifted(scene: Scene) -> Array:
        return scene.point(OBJECT)[..., 2] - STANDING_M

    def reward(scene: Scene) -> Array:
        distance = np.sqrt(np.add.reduce(reach(scene) ** 2, axis=-1))
        # Not np.clip, which takes many times as long, as does the method `sum` above.
        height = np.minimum(np.maximum(lifted(scene), 0.0), scene.goal["lift"][..., 0])
        return REWARD_PER_M * height - distance

    def done(scene: Scene) -> Flags:
        return lifted(scene) >= scene.goal["lift"][..., 0]

    return Task(
        observations={
            "position": JOINT_POSITIONS,
            "velocity": JOINT_VELOCITIES,
            "object": Observation(lambda scene: scene.point(OBJECT), -10.0, 10.0),
            "reach": Observation(reach, -10.0, 10.0),
            "rise": Observation(
                lambda scene: scene.goal["lift"] - lifted(scene)[..., None], -10.0, 10.0
            ),
        },
        reward=reward,
        terminated=done,
        succeeded=done,
        start=lambda scene, random: {"lift": random.uniform(LOWEST_LIFT_M, HIGHEST_LIFT_M, 1)},
    )


class ArmPick(ArmEnv):
    """Grip the cylinder with the myCobot and lift it; the seventh joint is the gripper.

    Args:
        actions: see `ArmEnv`.
        expert: whether infos contain the action of a planned pick as `expert_action`.
        options: further arguments of `ArmEnv`.
    """

    def __init__(self, actions: str = "step", expert: bool = False, **options: Any) -> None:
        if expert:
            options["expert"] = lambda env: pick_expert(env, OBJECT)
        super().__init__("mycobot", pick_task(), actions=actions, **_in_world(options))


def pick_batch(
    num_envs: int, max_episode_steps: int, actions: str = "step", **options: Any
) -> BatchEnv:
    """Return `num_envs` copies of `ArmPick`; `gymnasium.make_vec` calls it."""
    return BatchEnv(
        num_envs,
        "mycobot",
        pick_task(),
        actions=actions,
        max_episode_steps=max_episode_steps,
        **_in_world(options),
    )


def _in_world(options: Mapping[str, Any]) -> dict[str, Any]:
    """Return options with the world of the pick, unless they name another."""
    return {**options, "simulation": {"world": WORLD, **(options.get("simulation") or {})}}
