"""The myCobot's pick as an environment: a known way to the cylinder lifts it."""

import warnings
from collections.abc import Iterator

import gymnasium
import numpy as np
import pytest
from gymnasium.utils.env_checker import check_env

from arm_controller.pick_plan import CLOSED, WIDE_OPEN, JointPath, PickTask, plan_pick
from arm_sim.gym import ArmPick, BatchEnv

GRIP_S = 2.0


@pytest.fixture(scope="module")
def env() -> Iterator[ArmPick]:
    env = ArmPick(actions="position")
    yield env
    env.close()


def goals(env: ArmPick) -> Iterator[np.ndarray]:
    """Yield the positions of all joints for each action of a pick."""
    task = PickTask()
    plan = plan_pick(env.simulation.parts.robot.document, task)
    for path, grip in ((plan.to_object, WIDE_OPEN), (plan.approach, WIDE_OPEN)):
        yield from along(path, grip)
    arm = plan.approach[-1].positions
    for _ in range(round(GRIP_S / 0.04)):
        yield np.array([*arm, CLOSED])
    yield from along(plan.up, CLOSED)


def along(path: JointPath, grip: float) -> Iterator[np.ndarray]:
    times = [0.0, *(point.time_s for point in path)]
    positions = [path[0].positions, *(point.positions for point in path)]
    for time_s in np.arange(0.0, times[-1], 0.04):
        arm = [np.interp(time_s, times, joint) for joint in np.transpose(positions)]
        yield np.array([*arm, grip])


def test_gymnasiums_checker_has_nothing_to_say(env):
    with warnings.catch_warnings(record=True) as said:
        check_env(env, skip_render_check=True, skip_close_check=True)
    assert [str(warning.message) for warning in said] == []


def test_a_known_way_lifts_the_cylinder(env):
    seen, _ = env.reset(seed=0)
    middle, half = (env.upper + env.lower) / 2.0, (env.upper - env.lower) / 2.0
    rewards, terminated = [], False
    for goal in goals(env):
        seen, reward, terminated, truncated, info = env.step(
            ((goal - middle) / half).astype(np.float32)
        )
        rewards.append(reward)
        assert not truncated
        if terminated:
            break
    assert terminated
    assert info["is_success"]
    assert seen["rise"][0] <= 0.0
    assert rewards[-1] > 0.0 > rewards[0]


def test_copies_of_the_pick_have_the_same_bits(env):
    batch = gymnasium.make_vec("arm_sim/ArmPick-v0", num_envs=9, actions="position")
    assert isinstance(batch, BatchEnv)
    seen, wanted = batch.reset(seed=[4] * 9)[0], env.reset(seed=4)[0]
    action = np.full(7, 0.2, dtype=np.float32)
    for _ in range(10):
        for name, values in wanted.items():
            assert np.array_equal(seen[name][8], values)
        seen, wanted = batch.step(np.tile(action, (9, 1)))[0], env.step(action)[0]
    batch.close()


def test_the_world_of_the_launch_makes_no_difference(env):
    launched = ArmPick(actions="position", simulation={"world": "pick_and_place_demo"})
    bodies = [one.simulation.parts.physics.model.nbody for one in (env, launched)]
    assert bodies[0] < bodies[1]  # Groceries, which the arm does not reach.
    env.reset(seed=2)
    launched.reset(seed=2)
    middle, half = (env.upper + env.lower) / 2.0, (env.upper - env.lower) / 2.0
    for goal in goals(env):
        action = ((goal - middle) / half).astype(np.float32)
        seen, reward, lifted, *_ = env.step(action)
        there, reward_there, lifted_there, *_ = launched.step(action)
        for name, values in seen.items():
            assert there[name] == pytest.approx(values, abs=1e-6)
        assert reward_there == pytest.approx(reward, abs=1e-6)
        assert lifted_there == lifted
        if lifted:
            break
    assert lifted
    launched.close()
