import numpy as np
import pytest
from planning_models import model_of
from robots import joint, link, robot

from arm_planning.errors import PlanningError
from arm_planning.kinematics.group_kinematics import GroupKinematics

AXES = ("0 0 1", "0 1 0", "0 1 0", "1 0 0", "0 1 0", "1 0 0")
SEED = np.full(6, 0.5)


def kinematics_of(**positions: float) -> GroupKinematics:
    links = [link(name) for name in ("ground", "finger", *(f"l{n}" for n in range(7)))]
    joints = [
        joint("lift", "ground", "l0", axis="0 0 1", kind="prismatic"),
        joint("grip", "l6", "finger"),
        *(
            joint(f"j{n}", f"l{n}", f"l{n + 1}", axis=axis, xyz="0 0 0.2")
            for n, axis in enumerate(AXES)
        ),
    ]
    arm = (tuple(f"j{n}" for n in range(6)), "l6")
    return GroupKinematics(model_of(robot(*links, *joints), arm=arm), "arm", positions)


@pytest.fixture
def kinematics() -> GroupKinematics:
    return kinematics_of()


def test_each_link_is_placed_by_its_own(kinematics):
    assert kinematics.of("l5").tip == "l5"
    assert kinematics.of() is kinematics.of("l6")


def test_one_solution_or_several_are_given(kinematics):
    target = kinematics.of("l6").pose(SEED)
    (one,) = kinematics("l6", target, SEED, most=1, random_seed=0, any_turn=False)
    assert one == pytest.approx(SEED)
    several = kinematics("l6", target, SEED, most=8, random_seed=0, any_turn=False)
    assert 1 < len(several) <= 8
    assert several[0] == pytest.approx(SEED)


def test_any_orientation_may_do(kinematics):
    target = np.eye(4)
    target[:3, 3] = (0.7, 0.0, 0.2)
    with pytest.raises(PlanningError, match="cannot reach"):
        kinematics("l6", target, SEED, most=1, random_seed=0, any_turn=False)
    (found,) = kinematics("l6", target, SEED, most=1, random_seed=0, any_turn=True)
    assert kinematics.of("l6").pose(found)[:3, 3] == pytest.approx((0.7, 0.0, 0.2), abs=2e-5)


def test_positions_of_joints_below_the_arm_count(kinematics):
    low, high = (each.of("l6").pose(SEED) for each in (kinematics, kinematics_of(lift=0.3)))
    assert high[2, 3] == pytest.approx(low[2, 3] + 0.3)
