from dataclasses import replace

import numpy as np
import pytest
from planar_robot import planar_model
from planning_models import model_of
from robots import joint, link, robot

from arm_node.rigid_transform import RigidTransform
from arm_planning.errors import PlanningError
from arm_planning.kinematics.group_kinematics import (
    GroupKinematics,
    KinematicsSettings,
    kinematics_settings,
)
from arm_planning.planner import Planner

AXES = ("0 0 1", "0 1 0", "0 1 0", "1 0 0", "0 1 0", "1 0 0")
SEED = np.full(6, 0.5)
MODEL = planar_model()
TURNED = RigidTransform((0.5, 0.5, 0.0), (1.0, 0.0, 0.0, 0.0))
"""The arm reaches the place, but never upside down."""


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


def test_the_keys_of_moveit_are_read():
    given = {
        "arm.kinematics_solver": "kdl_kinematics_plugin/KDLKinematicsPlugin",
        "arm.kinematics_solver_timeout": 0.2,
        "arm.position_only_ik": True,
    }
    assert kinematics_settings(given, MODEL, pytest.fail) == {"arm": KinematicsSettings(0.2, True)}


def test_a_group_that_does_not_exist_is_named():
    said: list[str] = []
    assert not kinematics_settings({"leg.position_only_ik": True}, MODEL, said.append)
    assert said == ["robot_description_kinematics names the group 'leg'; the robot has arm"]


@pytest.mark.parametrize(
    ("name", "value"),
    [
        ("position_only_ik", "yes"),
        ("kinematics_solver_timeout", "long"),
        ("kinematics_solver_timeout", -1.0),
        ("kinematics_solver_timeout", float("nan")),
        ("kinematics_solver_timeout", 10**400),
        ("kinematics_solver_timeout", True),
    ],
)
def test_a_value_of_the_wrong_kind_is_refused(name, value):
    with pytest.raises(PlanningError, match=f"robot_description_kinematics.arm.{name} is"):
        kinematics_settings({f"arm.{name}": value}, MODEL, pytest.fail)


def test_position_only_leaves_the_orientation_open():
    with pytest.raises(PlanningError, match="orientation"):
        Planner(MODEL).inverse("arm", TURNED)
    planner = Planner(MODEL, kinematics={"arm": KinematicsSettings(position_only=True)})
    scene = replace(planner.scene, positions=planner.inverse("arm", TURNED))
    assert planner.link_pose("tip", scene).position == pytest.approx((0.5, 0.5, 0.0), abs=1e-5)


def test_position_only_lets_a_straight_path_turn_the_tip():
    planner = Planner(MODEL, kinematics={"arm": KinematicsSettings(position_only=True)})
    planner.scene = replace(planner.scene, positions={"shoulder": 0.0, "elbow": 1.0})
    x, y, z = planner.link_pose("tip").position
    end = RigidTransform((x - 0.1, y, z), TURNED.rotation)
    assert planner.cartesian_path("arm", [end], avoids_collisions=False).fraction == 1.0
