"""The example that learns to pick: the committed policy lifts, and training repeats."""

from pathlib import Path

import numpy as np
import pytest

EXAMPLE = Path(__file__).parents[2] / "examples" / "pick_policy"
PICKS, NEEDED = 4, 0.7


@pytest.fixture(autouse=True)
def _from_the_examples_folder(monkeypatch) -> None:
    monkeypatch.syspath_prepend(str(EXAMPLE))


@pytest.mark.filterwarnings("ignore:Could not import matplotlib")
def test_the_policy_lifts_the_cylinder_where_the_expert_never_showed_it():
    import imitate
    from pick_policy import JOINTS, load

    env = imitate.environment(expert=False)
    assert env.joints == JOINTS
    assert imitate.share_lifted(env, load(EXAMPLE / "policy.npz"), PICKS) >= NEEDED
    env.close()


def test_a_demonstration_is_learned_and_training_repeats(tmp_path):
    import imitate
    from pick_curve import Epoch, draw, write
    from pick_policy import CHUNK, JOINTS, load, save

    rows = imitate.demonstrations(1, seed=3)
    (policy, first), *_, (_, last) = imitate.clone(rows, 12, seed=1)
    again, _ = next(iter(imitate.clone(rows, 12, seed=1)))
    assert all(map(np.array_equal, policy.weights, again.weights))
    assert last < 0.5 * first
    save(policy, tmp_path / "policy.npz")
    joints, place = np.zeros(len(JOINTS)), np.array([0.22, 0.1])
    said = load(tmp_path / "policy.npz").commands(joints, place, 0.05)
    assert said.shape == (CHUNK, len(JOINTS))
    assert said == pytest.approx(policy.commands(joints, place, 0.05), abs=1e-5)
    curve = [Epoch(1, first, 0.0), Epoch(2, last, 0.5)]
    write(curve, tmp_path / "curve.csv")
    draw(curve, tmp_path / "curve.svg")
    assert (tmp_path / "curve.csv").read_text().count("\n") == 3
    assert "2 epochs" in (tmp_path / "curve.svg").read_text()


def test_the_node_picks_what_was_demonstrated():
    import pick_node

    from arm_sim.demonstrations import pick_scene
    from arm_sim.gym import arm_env, pick

    places = ("NEAREST_M", "FARTHEST_M", "MOST_ASIDE", "START_RAD", "MOST_CLOSED", "MOST_OPEN")
    for module, names in (
        (pick_scene, places),
        (pick, ("OBJECT", "STANDING_M", "LOWEST_LIFT_M", "HIGHEST_LIFT_M")),
        (arm_env, ("DECISION_S",)),
    ):
        assert [getattr(pick_node, n) for n in names] == [getattr(module, n) for n in names]
