"""Gymnasium environments of simulated arms; importing this package registers their ids.

The extra `gym` installs Gymnasium: `pip install 'arm-suite[gym]'`.
"""

from typing import Any

from arm_sim.errors import MissingPackageError

try:
    import gymnasium
except ModuleNotFoundError as error:
    raise MissingPackageError("Gymnasium", "gym") from error

from arm_sim.gym.actions import ACTIONS
from arm_sim.gym.arm_env import ArmEnv
from arm_sim.gym.batch_env import BatchEnv
from arm_sim.gym.pick import ArmPick
from arm_sim.gym.reach import ArmReach
from arm_sim.gym.task import Observation, Scene, Task

__all__ = ["ACTIONS", "ArmEnv", "ArmPick", "ArmReach", "BatchEnv", "Observation", "Scene", "Task"]

NAMESPACE = "arm_sim"
REACH_STEPS, PICK_STEPS = 100, 400


def _register(name: str, steps: int, **vector: Any) -> None:
    gymnasium.register(
        id=f"{NAMESPACE}/{name}-v0",
        entry_point=f"arm_sim.gym:{name}",
        max_episode_steps=steps,
        **vector,
    )


_register("ArmReach", REACH_STEPS, vector_entry_point="arm_sim.gym.reach:reach_batch")
_register("ArmPick", PICK_STEPS, vector_entry_point="arm_sim.gym.pick:pick_batch")
