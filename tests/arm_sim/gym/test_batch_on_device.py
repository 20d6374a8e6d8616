"""Copies of environments by MuJoCo Warp: near those on the host, with the same seeds and ends."""

import gymnasium
import numpy as np
import pytest

import arm_sim.gym  # noqa: F401  registers the ids
from arm_gazebo.errors import BatchError
from arm_sim.gym import BatchEnv, Task

COPIES = 4
ARM = {"simulation": {"arguments": {"camera": "none"}}}
ROUNDING = 1e-4
EPISODE = 6


@pytest.fixture(params=["cpu", "cuda"])
def device(request) -> str:
    pytest.importorskip("mujoco_warp", reason="the extra `gpu` is not installed")
    wp = pytest.importorskip("warp", reason="the extra `gpu` is not installed")
    if request.param == "cuda" and not wp.get_cuda_device_count():
        pytest.skip("there is no GPU")
    return request.param


@pytest.mark.parametrize(
    ("name", "options"), [("arm_sim/ArmReach-v0", ARM), ("arm_sim/ArmPick-v0", {})]
)
def test_copies_on_a_device_are_near_those_on_the_host(name, options, device):
    there = gymnasium.make_vec(name, num_envs=COPIES, device=device, **options)
    here = gymnasium.make_vec(name, num_envs=COPIES, **options)
    assert isinstance(there, BatchEnv)
    seen, wanted = there.reset(seed=7)[0], here.reset(seed=7)[0]
    random = np.random.default_rng(0)
    for _ in range(4):
        assert seen.keys() == wanted.keys()
        for key in seen:
            # Things lie on the floor from the first period, and fall asleep there on the host.
            assert np.allclose(seen[key], wanted[key], atol=1e-3), key
        actions = random.uniform(-1.0, 1.0, there.action_space.shape).astype(np.float32)
        seen, rewards, *_ = there.step(actions)
        wanted, due, *_ = here.step(actions)
        assert np.allclose(rewards, due, atol=1e-2)
    assert np.allclose(seen["position"], wanted["position"], atol=ROUNDING)
    there.close()
    here.close()


def test_episodes_end_and_start_again_copy_by_copy(device):
    options = {"max_episode_steps": EPISODE, **ARM}
    task = Task(terminated=lambda scene: scene.position[..., 0] > 0.2)
    env = BatchEnv(COPIES, "arm", task, actions="velocity", device=device, **options)
    env.reset(seed=0)
    actions = np.zeros((COPIES, 4), dtype=np.float32)
    actions[1, 0], actions[2, 0] = 0.6, -0.6
    ended = np.zeros((2, COPIES), dtype=int)
    for step in range(EPISODE):
        seen, _, terminated, truncated, infos = env.step(actions)
        ended += [terminated, truncated]
        if terminated[1]:
            assert infos["final_obs"][1]["position"][0] > 0.2
            assert not seen["position"][1].any()
            assert infos["final_obs"][2] is None or step == EPISODE - 1
    assert ended[0, 1] >= 1
    assert not ended[0, [0, 2, 3]].any()
    assert ended[1].tolist() == [1, 0, 1, 1]
    env.close()


@pytest.mark.parametrize("restart", [True, False])
def test_a_copy_that_becomes_unstable_is_truncated_with_finite_numbers(restart, device):
    env = gymnasium.make_vec(
        "arm_sim/ArmReach-v0", num_envs=COPIES, device=device, restart=restart, **ARM
    )
    env.reset(seed=0)
    actions = np.full((COPIES, 4), 0.5, dtype=np.float32)
    env.step(actions)
    physics = env._physics
    velocities = physics._data.qvel.numpy()
    velocities[2] = np.nan
    physics._data.qvel.assign(velocities)
    seen, rewards, _, truncated, infos = env.step(actions)
    assert truncated.tolist() == [False, False, True, False]
    assert np.isfinite(rewards).all()
    assert all(np.isfinite(values).all() for values in seen.values())
    assert all(np.isfinite(values).all() for values in infos["final_obs"][2].values())
    assert not seen["position"][2].any()
    seen, _, _, truncated, _ = env.step(actions)
    assert not truncated.any()
    assert seen["position"][2].any()
    env.close()


def test_equal_seeds_give_equal_numbers_on_a_device(device):
    runs = []
    for _ in range(2):
        env = gymnasium.make_vec("arm_sim/ArmReach-v0", num_envs=COPIES, device=device, **ARM)
        seen = [env.reset(seed=3)[0]]
        for _ in range(3):
            seen.append(env.step(np.full((COPIES, 4), 0.4, dtype=np.float32))[0])
        runs.append(seen)
        env.close()
    for one, other in zip(*runs, strict=True):
        assert all(np.array_equal(one[name], other[name]) for name in one)


def test_a_device_that_does_not_exist_is_a_sentence():
    with pytest.raises(BatchError, match="no device 'gpu'; there are host, cuda"):
        BatchEnv(2, "arm", device="gpu", **ARM)
