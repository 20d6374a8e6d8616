"""Inverse kinematics of made-up arms: what is found, and why nothing is."""

import math

import numpy as np
import pytest
from planning_models import model_of
from robots import joint, link, robot

from arm_description import UrdfError, parse_urdf
from arm_description.transforms import rotation_about, transform
from arm_node.rigid_transform import RigidTransform
from arm_planning.errors import MoveItErrorCode, PlanningError
from arm_planning.kinematics.inverse import InverseKinematics
from arm_planning.kinematics.search import Orientation

AXES = {
    4: ("0 0 1", "0 1 0", "0 1 0", "0 1 0"),
    5: ("0 0 1", "0 1 0", "0 1 0", "0 1 0", "1 0 0"),
    6: ("0 0 1", "0 1 0", "0 1 0", "1 0 0", "0 1 0", "1 0 0"),
    7: ("0 0 1", "0 1 0", "0 0 1", "0 1 0", "0 0 1", "0 1 0", "0 0 1"),
}


def arm_urdf(size: int, *more: str, limits: tuple[float, float] = (-2.5, 2.5)) -> str:
    links = [link(f"l{n}") for n in range(size + 1)]
    joints = [
        joint(f"j{n}", f"l{n}", f"l{n + 1}", axis=axis, xyz="0.02 0 0.2", limits=limits)
        for n, axis in enumerate(AXES[size])
    ]
    return robot(*links, *joints, *more, name=f"arm{size}")


def arm(size: int, *more: str, limits: tuple[float, float] = (-2.5, 2.5)) -> InverseKinematics:
    names = tuple(f"j{n}" for n in range(size))
    model = model_of(arm_urdf(size, *more, limits=limits), arm=(names, f"l{size}"))
    return InverseKinematics(model, "arm")


def one_joint(axis: str, kind: str = "revolute", limits=(-4.0, 4.0)) -> InverseKinematics:
    urdf = robot(
        link("l0"), link("l1"), joint("j", "l0", "l1", axis=axis, kind=kind, limits=limits)
    )
    return InverseKinematics.for_link(parse_urdf(urdf), "l1", ("j",))


@pytest.mark.parametrize("size", AXES)
def test_poses_that_the_arm_can_take_are_found_from_anywhere(size):
    kinematics, random = arm(size), np.random.default_rng(size)
    for _ in range(100):
        target = kinematics.pose(random.uniform(-2.5, 2.5, size))
        found = kinematics.solve(target, random.uniform(-2.5, 2.5, size))
        assert kinematics.pose(found) == pytest.approx(target, abs=1.5e-5)
        assert np.abs(found).max() <= 2.5


def test_a_solution_beside_the_seed_is_kept():
    kinematics = arm(6)
    positions = np.array([0.3, -0.4, 0.5, 0.9, 0.6, -0.2])
    found = kinematics.solve(kinematics.pose(positions), positions + 0.1)
    assert found == pytest.approx(positions, abs=1e-4)


@pytest.mark.parametrize("size", AXES)
def test_a_seed_beside_the_target_leads_to_it_wherever_the_arm_is(size):
    kinematics, random = arm(size), np.random.default_rng(size)
    for _ in range(300):
        positions = random.uniform(-2.5, 2.5, size)
        seed = np.clip(positions + random.uniform(-0.05, 0.05, size), -2.5, 2.5)
        target = kinematics.pose(positions)
        assert kinematics.pose(kinematics.follow(target, seed)) == pytest.approx(target, abs=1.5e-4)


def test_joints_may_stand_in_any_order():
    names = tuple(f"j{n}" for n in reversed(range(6)))
    kinematics = InverseKinematics.for_link(parse_urdf(arm_urdf(6)), "l6", names)
    positions = np.array([0.3, -0.4, 0.5, 0.9, 0.6, -0.2])
    found = kinematics.solve(kinematics.pose(positions), positions + 0.1)
    assert found == pytest.approx(positions, abs=1e-4)


def test_the_same_call_gives_the_same_answer_whatever_came_before():
    used, random = arm(7), np.random.default_rng(0)
    for _ in range(5):
        used.solve(used.pose(random.uniform(-2.5, 2.5, 7)), np.zeros(7))
    target, seed = used.pose(random.uniform(-2.5, 2.5, 7)), random.uniform(-2.5, 2.5, 7)
    assert np.array_equal(used.solve(target, seed), arm(7).solve(target, seed))


@pytest.mark.parametrize("axis", ["1 0 0", "0 0.6 0.8", "0 0 -1"])
def test_half_a_turn_is_found(axis):
    kinematics = one_joint(axis)
    found = kinematics.solve(kinematics.pose((math.pi,)), (0.0,))
    assert np.abs(found) == pytest.approx(math.pi)


def test_sliding_joints_move_and_endless_ones_too():
    slides = [
        joint(name, f"l{n}", f"l{n + 1}", axis=axis, xyz="0 0 0.1", kind="prismatic")
        for n, (name, axis) in enumerate(zip("xyz", ("1 0 0", "0 1 0", "0 0 1"), strict=True))
    ]
    gantry = parse_urdf(robot(*(link(f"l{n}") for n in range(4)), *slides))
    kinematics = InverseKinematics.for_link(gantry, "l3", ("x", "y", "z"))
    target = transform(np.eye(3), (0.4, -0.3, 0.8))
    assert kinematics.solve(target, (0.0, 0.0, 0.0)) == pytest.approx((0.4, -0.3, 0.5), abs=1e-5)


@pytest.mark.parametrize(
    ("seed", "found"), [(0.0, 0.5), (6.0, 0.5 + math.tau), (-7.0, 0.5 - math.tau)]
)
def test_a_continuous_joint_ends_on_the_turn_next_to_the_seed(seed, found):
    kinematics = one_joint("0 0 1", "continuous", limits=None)
    target = kinematics.pose((0.5,))
    assert kinematics.solve(target, (seed,)) == pytest.approx([found], abs=1e-4)


def test_a_limited_joint_of_several_turns_stays_inside_its_limits():
    kinematics = one_joint("0 0 1", limits=(-7.0, 7.0))
    found = kinematics.solve(kinematics.pose((-1.0,)), (6.9,))
    assert found == pytest.approx([math.tau - 1.0], abs=1e-4)


@pytest.mark.parametrize("value", [0.0, 0.7, -900.0])
def test_a_joint_that_must_not_move_stays(value):
    parts = (
        joint("locked", "l0", "l1", limits=(value, value)),
        joint("elbow", "l1", "l2", xyz="0 0 0.4"),
        joint("tip", "l2", "l3", xyz="0 0 0.4", kind="fixed", limits=None),
    )
    arm = parse_urdf(robot(*(link(f"l{n}") for n in range(4)), *parts))
    kinematics = InverseKinematics.for_link(arm, "l3", ("locked", "elbow"))
    found = kinematics.solve(kinematics.pose((value, 1.2)), (value, -0.2))
    assert found == pytest.approx((value, 1.2), abs=1e-5)
    assert found[0] == value


def test_mimic_joints_follow_their_leaders():
    elbow = joint("e", "l1", "l2", "<mimic joint='s' multiplier='-2' offset='0.3'/>", xyz="0 0 0.4")
    shoulder = joint("s", "l0", "l1")
    wrist = joint("w", "l2", "l3", xyz="0 0 0.3")
    folding = robot(*(link(f"l{n}") for n in range(4)), shoulder, elbow, wrist)
    kinematics = InverseKinematics(model_of(folding, arm=(("s", "w"), "l3")), "arm")
    found = kinematics.solve(kinematics.pose((0.4, -0.7)), (0.0, 0.0))
    assert found == pytest.approx((0.4, -0.7), abs=1e-4)


def test_other_joints_stay_where_they_are():
    lift = joint("lift", "ground", "l0", axis="0 0 1", kind="prismatic")
    urdf = arm_urdf(6, link("ground"), lift)
    names = tuple(f"j{n}" for n in range(6))
    low, high = (
        InverseKinematics(model_of(urdf, arm=(names, "l6")), "arm", positions=positions)
        for positions in (None, {"lift": 0.5})
    )
    positions = np.array([0.3, -0.4, 0.5, 0.9, 0.6, -0.2])
    assert high.pose(positions)[2, 3] == pytest.approx(low.pose(positions)[2, 3] + 0.5)
    assert high.solve(high.pose(positions), positions) == pytest.approx(positions)


def test_joints_of_the_group_that_do_not_carry_the_tip_keep_the_seeds_positions():
    finger = joint("finger", "l6", "l7")
    names = (*(f"j{n}" for n in range(6)), "finger")
    model = model_of(arm_urdf(6, link("l7"), finger), hand=(names, ""))
    kinematics = InverseKinematics(model, "hand", "l6")
    target = kinematics.pose(np.full(7, 0.5))
    found = kinematics.solve(target, (*np.zeros(6), 0.7))
    assert found[6] == 0.7
    assert kinematics.pose(found) == pytest.approx(target, abs=1.5e-5)


def test_a_seed_beyond_the_limits_is_moved_inside():
    kinematics = arm(6)
    found = kinematics.solve(kinematics.pose(np.full(6, 2.4)), np.full(6, 9.0))
    assert np.abs(found).max() <= 2.5


def test_a_target_may_be_a_rigid_transform():
    kinematics = arm(6)
    target = RigidTransform((0.3, 0.1, 0.5), (0.0, math.sqrt(0.5), 0.0, math.sqrt(0.5)))
    found = kinematics.solve(target, np.zeros(6))
    assert kinematics.pose(found) == pytest.approx(np.array(target.matrix()), abs=1.5e-5)


def test_only_free_solutions_are_returned():
    kinematics = arm(6)
    target = kinematics.pose(np.full(6, 0.5))
    found = kinematics.solve(target, np.full(6, 0.5), free=lambda q: q[2] < 0.0)
    assert found[2] < 0.0
    assert kinematics.pose(found) == pytest.approx(target, abs=1.5e-5)


def test_solutions_that_are_all_in_collision_are_counted():
    kinematics = arm(6)
    target = kinematics.pose(np.full(6, 0.5))
    with pytest.raises(PlanningError, match=r"can reach .*, but all \d+ solutions found are in c"):
        kinematics.solve(target, np.zeros(6), free=lambda q: False)


def timed(*times_s: float, limit: float = 2.5) -> InverseKinematics:
    """The kinematics of six joints on a clock that shows these times."""
    urdf = arm_urdf(6, limits=(-limit, limit))
    model = model_of(urdf, arm=(tuple(f"j{n}" for n in range(6)), "l6"))
    return InverseKinematics(model, "arm", clock=iter(times_s).__next__)


def test_a_search_ends_when_its_time_is_up_on_the_clock():
    # A second a descent, as on a machine that is busy with other things.
    kinematics = timed(0.0, 1.0, 2.0, 3.0, limit=0.1)
    target = transform(np.eye(3), (0.5, 0.0, 0.5))
    with pytest.raises(PlanningError, match=r"'l6' cannot reach .* time .* ended with") as refused:
        kinematics.solve(target, np.zeros(6), timeout_s=2.0)
    assert refused.value.code is MoveItErrorCode.TIMED_OUT


def test_a_collision_check_that_takes_forever_ends_the_search():
    kinematics = timed(0.0, 0.9, 1.1)
    target = kinematics.pose(np.full(6, 0.5))
    with pytest.raises(
        PlanningError, match="all 2 solutions found are in collision; the"
    ) as refused:
        kinematics.solve(target, np.full(6, 0.5), free=lambda _: False)
    assert refused.value.code is MoveItErrorCode.TIMED_OUT


def test_other_solutions_are_not_looked_for_when_the_time_is_up():
    kinematics = timed(0.0, 1.1)
    target = kinematics.pose(np.full(6, 0.5))
    with pytest.raises(PlanningError, match="may have other solutions; the time"):
        kinematics.solutions(target, np.full(6, 0.5), free=lambda _: True)


def test_several_solutions_come_in_the_order_of_their_distance():
    kinematics = arm(7)
    seed = np.array([0.4, 0.6, 0.7, 0.3, 0.5, 0.1, -0.8])
    target = kinematics.pose(seed)
    found = kinematics.solutions(target, seed, most=4)
    assert len(found) == 4
    assert found[0] == pytest.approx(seed, abs=1e-4)
    distances = [float(np.linalg.norm(q - seed)) for q in found]
    assert distances == sorted(distances)
    assert min(np.abs(a - b).max() for a in found for b in found if a is not b) > 1e-2
    for q in found:
        assert kinematics.pose(q) == pytest.approx(target, abs=1.5e-5)


def test_the_position_alone_is_enough_if_asked():
    kinematics = arm(4)
    target = transform(rotation_about((1.0, 0.0, 0.0), 1.0), (0.3, 0.2, 0.4))
    found = kinematics.solve(target, np.zeros(4), orientation=Orientation.ANY)
    assert kinematics.pose(found)[:3, 3] == pytest.approx((0.3, 0.2, 0.4), abs=1e-6)


def test_the_nearest_orientation_is_found_at_the_exact_place():
    """A planar arm cannot roll, so the best it can do is to pitch as wanted."""
    links = [link(f"l{n}") for n in range(4)]
    joints = [joint(f"j{n}", f"l{n}", f"l{n + 1}", xyz="0 0 0.3") for n in range(3)]
    names = ("j0", "j1", "j2")
    planar = InverseKinematics(model_of(robot(*links, *joints), arm=(names, "l3")), "arm")
    flat = planar.pose((0.4, 0.7, -0.5))
    rolled = flat @ transform(rotation_about((0.0, 0.0, 1.0), 0.3), (0.0, 0.0, 0.0))
    found = planar.pose(planar.solve(rolled, np.zeros(3), orientation=Orientation.NEAREST))
    assert found[:3, 3] == pytest.approx(flat[:3, 3], abs=1e-6)
    assert found[:3, :3] == pytest.approx(flat[:3, :3], abs=2e-3)


def test_with_few_joints_the_message_says_what_to_ask_for():
    kinematics = arm(5)
    target = transform(rotation_about((1.0, 0.0, 0.0), 1.0), (0.3, 0.2, 0.4))
    with pytest.raises(PlanningError, match="with 5 joints most orientations cannot be had") as no:
        kinematics.solve(target, np.zeros(5))
    assert no.value.code is MoveItErrorCode.NO_IK_SOLUTION


def test_a_place_beyond_the_arms_length_is_refused_with_the_distances():
    kinematics = arm(6)
    with pytest.raises(PlanningError, match=r"'l6' cannot reach \(2.000, 0.000, 0.000\) m") as no:
        kinematics.solve(transform(np.eye(3), (2.0, 0.0, 0.0)), np.full(6, 0.1))
    assert "the place is 1.990 m from the first joint, and the arm is 1.005 m long" in str(no.value)


def test_joints_at_their_limits_are_named():
    kinematics = one_joint("0 0 1", limits=(-0.5, 0.5))
    target = transform(rotation_about((0.0, 0.0, 1.0), 1.0), (0.0, 0.0, 0.0))
    with pytest.raises(PlanningError, match="is off by 0 mm and 29 degrees; there joint j is at "):
        kinematics.solve(target, (0.0,))


NAN = float("nan")


@pytest.mark.parametrize(
    ("target", "message"),
    [
        (RigidTransform((NAN, 0.0, 0.0)), "position of the target is not finite: nan, 0, 0"),
        (RigidTransform((0.0, 1e300, 0.0)), r"is beyond 1e\+06 m: 0, 1e\+300, 0"),
        (RigidTransform(rotation=(0.0, 0.0, 0.0, 0.0)), "no unit quaternion: its norm is 0;"),
        (RigidTransform(rotation=(0.0, 0.0, 1.0, 1.0)), "no unit quaternion: its norm is 1.414;"),
        (RigidTransform(rotation=(0.0, 0.0, NAN, 1.0)), "no unit quaternion: its norm is nan;"),
        (np.eye(3), r"a transform of shape \(4, 4\), not \(3, 3\)"),
        (np.diag((2.0, 1.0, 1.0, 1.0)), "rotation matrix is not orthonormal"),
        (np.diag((-1.0, 1.0, 1.0, 1.0)), "rotation matrix is not orthonormal and right-handed"),
        (np.full((4, 4), NAN), "not finite"),
    ],
)
def test_a_target_that_is_no_pose_is_refused(target, message):
    with pytest.raises(PlanningError, match=message) as refused:
        arm(6).solve(target, np.zeros(6))
    assert refused.value.code is MoveItErrorCode.INVALID_GOAL_CONSTRAINTS


@pytest.mark.parametrize(
    ("seed", "message"),
    [
        (
            (0.0, 0.0),
            r"group 'arm' has 6 positions, for j0, .*; the given one has the shape \(2,\)",
        ),
        ((0.0, NAN, 0.0, 0.0, 0.0, 0.0), "the position of joint 'j1' is not finite: nan"),
    ],
)
def test_a_seed_that_is_no_state_is_refused(seed, message):
    kinematics = arm(6)
    with pytest.raises(PlanningError, match=message) as refused:
        kinematics.solve(np.eye(4), seed)
    assert refused.value.code is MoveItErrorCode.INVALID_ROBOT_STATE


def test_a_continuous_joint_that_has_turned_too_often_is_refused():
    kinematics = one_joint("0 0 1", "continuous", limits=None)
    assert kinematics.solve(np.eye(4), (1e5,)) == pytest.approx([1e5], abs=math.pi)
    with pytest.raises(PlanningError, match="position of joint 'j' is beyond 1e\\+06: 1e\\+17"):
        kinematics.solve(np.eye(4), (1e17,))


@pytest.mark.parametrize("timeout_s", [0.0, -1.0, math.inf])
def test_any_timeout_but_nan_ends_the_search(timeout_s):
    kinematics = arm(6)
    target = kinematics.pose(np.full(6, 0.5))
    assert kinematics.solve(target, np.zeros(6), timeout_s=timeout_s).shape == (6,)
    with pytest.raises(PlanningError, match="timeout is not a number"):
        kinematics.solve(target, np.zeros(6), timeout_s=NAN)


def test_a_tip_that_no_joint_of_the_group_moves_is_refused():
    model = model_of(arm_urdf(6), wrist=(("j4", "j5"), "l6"))
    with pytest.raises(PlanningError, match="no joint of group 'wrist' moves link 'l2'"):
        InverseKinematics(model, "wrist", "l2")


def test_unknown_groups_and_links_are_refused_with_those_that_exist():
    model = model_of(arm_urdf(4), arm=(("j0", "j1"), ""))
    with pytest.raises(PlanningError, match="no group 'leg'; the robot has arm"):
        InverseKinematics(model, "leg")
    with pytest.raises(PlanningError, match="group 'arm' is not a chain: name the link to place"):
        InverseKinematics(model, "arm")
    with pytest.raises(PlanningError, match="no link 'foot'; the robot has l0, l1"):
        InverseKinematics(model, "arm", "foot")
    with pytest.raises(UrdfError, match="no link 'foot'"):
        InverseKinematics.for_link(model.robot, "foot", ("j0",))


def test_a_joint_without_a_single_position_is_refused():
    floating = parse_urdf(robot(link("l0"), link("l1"), joint("j", "l0", "l1", kind="floating")))
    with pytest.raises(PlanningError, match="joint 'j' is floating"):
        InverseKinematics.for_link(floating, "l1", ("j",))
