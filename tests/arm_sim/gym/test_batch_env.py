"""Copies in threads: to the bit the environments that Gymnasium steps one by one."""

import gymnasium
import numpy as np
import pytest
from gymnasium.vector import AutoresetMode

import arm_sim.gym  # noqa: F401  registers the ids
from arm_gazebo.batch.choice import SERIAL_COPIES
from arm_sim.gym import BatchEnv, Observation, Task

COPIES = SERIAL_COPIES + 1
STEPS = 32
OPTIONS = {"simulation": {"arguments": {"camera": "none"}}, "tolerance_m": 0.12}
"""A tolerance that random motions meet, so that episodes end both ways."""


def make(restart: bool) -> tuple[gymnasium.vector.VectorEnv, gymnasium.vector.VectorEnv]:
    name = f"test/Reach{restart}-v0"
    gymnasium.register(
        id=name,
        entry_point="arm_sim.gym:ArmReach",
        vector_entry_point="arm_sim.gym.reach:reach_batch",
        max_episode_steps=15,
    )
    options = {**OPTIONS, "restart": restart}
    batch = gymnasium.make_vec(name, num_envs=COPIES, **options)
    single = gymnasium.make_vec(
        name,
        num_envs=COPIES,
        vectorization_mode="sync",
        vector_kwargs={"autoreset_mode": AutoresetMode.SAME_STEP},
        **options,
    )
    return batch, single


@pytest.mark.parametrize("restart", [True, False])
def test_a_batch_gives_the_bits_of_single_environments(restart):
    batch, single = make(restart)
    assert isinstance(batch, BatchEnv)
    assert batch.observation_space == single.observation_space
    seen, _ = batch.reset(seed=3)
    wanted, _ = single.reset(seed=3)
    random = np.random.default_rng(0)
    terminations = truncations = 0
    for _ in range(STEPS):
        assert seen.keys() == wanted.keys()
        assert all(np.array_equal(seen[name], wanted[name]) for name in seen)
        actions = random.uniform(-1.0, 1.0, (COPIES, 4)).astype(np.float32)
        seen, *got, infos = batch.step(actions)
        wanted, *due, due_infos = single.step(actions)
        assert all(np.array_equal(one, other) for one, other in zip(got, due, strict=True))
        assert ("final_obs" in infos) == ("final_obs" in due_infos)
        for index in np.flatnonzero(got[1] | got[2]):
            last, due_last = infos["final_obs"][index], due_infos["final_obs"][index]
            assert all(np.array_equal(last[name], due_last[name]) for name in last)
            final, due_final = infos["final_info"], due_infos["final_info"]
            assert final["is_success"][index] == due_final["is_success"][index]
        terminations += got[1].sum()
        truncations += got[2].sum()
    assert terminations
    assert truncations
    batch.close()
    single.close()


def test_processes_give_the_same_bits():
    options = {**OPTIONS, "vectorization_mode": "async"}
    parallel = gymnasium.make_vec("arm_sim/ArmReach-v0", num_envs=2, **options)
    batch = gymnasium.make_vec("arm_sim/ArmReach-v0", num_envs=2, **OPTIONS)
    seen, wanted = parallel.reset(seed=5)[0], batch.reset(seed=5)[0]
    for _ in range(5):
        assert all(np.array_equal(seen[name], wanted[name]) for name in seen)
        actions = np.full((2, 4), 0.3, dtype=np.float32)
        seen, wanted = parallel.step(actions)[0], batch.step(actions)[0]
    parallel.close()
    batch.close()


def test_a_users_task_runs_in_a_batch():
    task = Task(
        observations={"tip": Observation(lambda scene: scene.point("crawer_base"), -2.0, 2.0)},
        reward=lambda scene: scene.position[..., 0],
    )
    env = BatchEnv(2, "arm", task, actions="velocity", simulation=OPTIONS["simulation"])
    env.reset(seed=0)
    seen, rewards, *_ = env.step(np.array([[1, 0, 0, 0], [-1, 0, 0, 0]], dtype=np.float32))
    assert seen["tip"].shape == (2, 3)
    assert rewards[0] > 0.0 > rewards[1]
    env.close()
