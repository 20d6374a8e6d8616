"""The environment of any robot: Gymnasium's own checks, seeds, actions, what goes wrong."""

import warnings
from collections.abc import Iterator
from pathlib import Path

import gymnasium
import numpy as np
import pytest
from gymnasium.utils.env_checker import check_env

from arm_sim import CallError, UnknownNameError
from arm_sim.gym import ArmEnv, ArmReach, Observation, Task

NO_CAMERA = {"arguments": {"camera": "none"}}
PENDULUM = """
<robot name="pendulum">
  <link name="post"/>
  <link name="rod"><inertial><origin xyz="0 0 -0.2"/><mass value="0.5"/>
    <inertia ixx="0.01" iyy="0.01" izz="0.001" ixy="0" ixz="0" iyz="0"/></inertial></link>
  <joint name="hinge" type="continuous"><parent link="post"/><child link="rod"/>
    <origin xyz="0 0 1"/><axis xyz="0 1 0"/><limit effort="{effort}" velocity="4"/></joint>
</robot>
"""


@pytest.fixture
def pendulum(tmp_path) -> Path:
    file = tmp_path / "pendulum.urdf"
    file.write_text(PENDULUM.format(effort=3))
    return file


@pytest.fixture(scope="module")
def reach() -> Iterator[ArmReach]:
    env = ArmReach(simulation=NO_CAMERA)
    yield env
    env.close()


@pytest.mark.gl
def test_gymnasiums_checker_has_nothing_to_say():
    env = gymnasium.make("arm_sim/ArmReach-v0")
    with warnings.catch_warnings(record=True) as said:
        check_env(env.unwrapped)
    env.close()
    assert [str(warning.message) for warning in said] == []


@pytest.mark.parametrize("actions", ["position", "step", "velocity", "effort"])
def test_the_checker_accepts_all_actions_and_any_robot(pendulum, actions):
    env = ArmEnv(pendulum, actions=actions)
    with warnings.catch_warnings(record=True) as said:
        check_env(env, skip_render_check=True)
    env.close()
    assert [str(warning.message) for warning in said] == []


def states(env: ArmEnv, seed: int | None, count: int = 20) -> list[bytes]:
    env.action_space.seed(7)
    seen, _ = env.reset(seed=seed)
    found = [b"".join(values.tobytes() for values in seen.values())]
    for _ in range(count):
        env.step(env.action_space.sample())
        found.append(env.simulation.parts.physics.data.qpos.tobytes())
    return found


def test_equal_seeds_have_equal_bits_whatever_came_before(reach):
    first = states(reach, 1)
    other = states(reach, 2)
    assert states(reach, 1) == first
    assert first[0] != other[0]
    assert states(reach, None)[0] != first[0]


def test_an_episode_goes_on_where_the_robot_is_if_it_does_not_restart():
    env = ArmReach(simulation=NO_CAMERA, restart=False)
    states(env, 1)
    moved = env.position
    before = env.goal["point"]
    env.reset()
    assert np.array_equal(env.position, moved)
    assert not np.array_equal(env.goal["point"], before)
    env.reset(seed=1)
    assert not env.position.any()
    env.close()


def test_an_action_of_one_is_the_limit(pendulum):
    for actions, limit in (("position", np.pi), ("velocity", 4.0), ("effort", 3.0), ("step", 0.16)):
        env = ArmEnv(pendulum, actions=actions)
        env.reset(seed=0)
        env.step(np.array([1.0], dtype=np.float32))
        assert env.command == pytest.approx([limit])
        env.close()


def test_a_users_functions_make_the_task(pendulum):
    task = Task(
        observations={"tip": Observation(lambda scene: scene.point("rod"), -2.0, 2.0)},
        reward=lambda scene: scene.position[..., 0],
        terminated=lambda scene: scene.position[..., 0] > 0.05,
    )
    env = ArmEnv(pendulum, task, actions="velocity")
    seen, _ = env.reset(seed=0)
    assert seen["tip"] == pytest.approx([0.0, 0.0, 1.0])
    for _ in range(10):
        _, reward, terminated, truncated, _ = env.step(np.array([1.0], dtype=np.float32))
        assert reward == env.position[0]
        if terminated:
            break
    assert terminated
    assert not truncated
    env.close()


@pytest.mark.gl
def test_images_of_cameras_are_observations():
    env = ArmEnv("arm", cameras=["camera"], actions="step")
    seen, _ = env.reset(seed=0)
    assert env.observation_space.contains(seen)
    image = seen["camera"]
    assert image.shape == (240, 320, 3)
    assert np.ptp(image) > 50
    env.close()


def test_an_unstable_physics_truncates_the_episode(pendulum):
    env = ArmEnv(pendulum, actions="effort")
    env.reset(seed=0)
    still = np.array([0.0], dtype=np.float32)
    env.step(still)
    env.simulation.parts.physics.data.qvel[0] = np.nan
    _, _, terminated, truncated, info = env.step(still)
    assert (terminated, truncated) == (False, True)
    assert "unstable" in info["failure"]
    env.close()


def test_what_cannot_be_used_is_said(pendulum, tmp_path, reach):
    with pytest.raises(CallError, match="no actions 'torque'; there are position, step"):
        ArmEnv(pendulum, actions="torque")
    with pytest.raises(
        CallError,
        match="there is no joint 'j9' with the command interface 'position'; there are hinge",
    ):
        ArmEnv(pendulum, joints=["j9"])
    with pytest.raises(CallError, match=r"0.015 s, which is not a whole number"):
        ArmEnv(pendulum, decision_s=0.015)
    with pytest.raises(CallError, match="no render mode 'human'; the only one is rgb_array"):
        ArmEnv(pendulum, render_mode="human")
    with pytest.raises(UnknownNameError, match="no link 'hand'; there are "):
        reach.point("hand")
    strong = tmp_path / "strong.urdf"
    strong.write_text(PENDULUM.format(effort=0))
    with pytest.raises(CallError, match="'hinge' has no effort limit"):
        ArmEnv(strong, actions="effort")
    with pytest.raises(CallError, match="link 'post' has no goals"):
        ArmReach(str(pendulum), tip="post")
