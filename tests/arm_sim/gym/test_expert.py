"""The action of an expert in the infos of environments."""

import numpy as np
import pytest

from arm_sim import CallError
from arm_sim.gym import ArmPick, ArmReach


@pytest.mark.parametrize("actions", ["step", "position"])
def test_the_experts_actions_reach_the_goal(actions):
    env = ArmReach(actions=actions, expert=True)
    for seed in range(5):
        _, info = env.reset(seed=seed)
        assert info["expert_action"] in env.action_space
        for _ in range(40):
            _, _, reached, _, info = env.step(info["expert_action"])
            if reached:
                break
        assert info["is_success"]
    env.close()


def test_the_expert_of_the_pick_leads_back_after_anothers_actions():
    env = ArmPick(expert=True)
    _, info = env.reset(seed=0)
    random = np.random.default_rng(0)
    for step in range(300):
        is_others = 20 <= step < 40
        action = random.uniform(-0.3, 0.3, 7) if is_others else info["expert_action"]
        _, _, lifted, _, info = env.step(np.asarray(action, np.float32))
        if lifted:
            break
    env.close()
    assert info["is_success"]


def test_without_an_expert_infos_are_as_before():
    env = ArmReach()
    assert env.reset(seed=0)[1] == {}
    assert list(env.step(np.zeros(4, np.float32))[4]) == ["is_success"]
    env.close()


def test_an_expert_needs_actions_of_positions():
    with pytest.raises(CallError, match=r"an expert commands positions.* no actions 'velocity'"):
        ArmReach(actions="velocity", expert=True)


def test_the_expert_of_the_pick_needs_all_joints():
    env = ArmPick(expert=True, joints=["link1_to_link2", "gripper_controller"])
    with pytest.raises(CallError, match=r"the expert needs all joints; link2_to_link3"):
        env.reset(seed=0)
    env.close()
