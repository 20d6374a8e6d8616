"""The example that learns to reach: the committed policy works, and training repeats."""

from pathlib import Path

import numpy as np
import pytest

EXAMPLE = Path(__file__).parents[2] / "examples" / "reach_policy"
GOALS = 60
STEPS = 100
NEEDED = 0.95


@pytest.fixture(autouse=True)
def _from_the_examples_folder(monkeypatch) -> None:
    monkeypatch.syspath_prepend(str(EXAMPLE))


def test_the_policy_reaches_goals_that_it_was_not_trained_with():
    import gymnasium
    from policy import act, load

    import arm_sim.gym  # noqa: F401  registers the ids

    weights = load(EXAMPLE / "policy.json")
    env = gymnasium.make_vec("arm_sim/ArmReach-v0", num_envs=GOALS, restart=False)
    seen, _ = env.reset(seed=77)
    ended, reached = np.zeros(GOALS, dtype=bool), np.zeros(GOALS, dtype=bool)
    for _ in range(STEPS):
        actions = act(weights, seen["position"], seen["error"]).astype(np.float32)
        seen, _, terminated, truncated, _ = env.step(actions)
        reached |= terminated & ~ended
        ended |= terminated | truncated
    env.close()
    assert ended.all()
    assert reached.mean() >= NEEDED


@pytest.mark.filterwarnings("ignore:Could not import matplotlib")
def test_training_repeats_with_its_seed(tmp_path, monkeypatch):
    import train
    from curve import draw, write

    for name, value in (("CANDIDATES", 6), ("GOALS", 2), ("EPISODE_STEPS", 10)):
        monkeypatch.setattr(train, name, value)
    weights, curve = train.train(2, seed=3)
    again, _ = train.train(2, seed=3)
    assert np.array_equal(weights, again)
    assert weights.any()
    assert [0.0 <= one.reached <= 1.0 for one in curve] == [True, True]
    write(curve, tmp_path / "curve.csv")
    draw(curve, tmp_path / "curve.svg")
    assert (tmp_path / "curve.csv").read_text().count("\n") == 3
    assert "2 generations" in (tmp_path / "curve.svg").read_text()


def test_the_node_that_drives_has_the_goals_of_the_environment():
    import drive_node

    from arm_sim.gym import reach

    names = ("RANGE_SHARE", "LOWEST_M", "NEAREST_M", "TOLERANCE_M", "TIP")
    assert [getattr(drive_node, name) for name in names] == [getattr(reach, n) for n in names]
