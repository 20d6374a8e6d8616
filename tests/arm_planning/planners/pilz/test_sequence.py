import numpy as np
import pytest
from pilz_arm import MODEL, READY, START, asked, joint_goal, pose_goal, tip_offsets
from planning_models import model_of
from robots import joint, link, robot

from arm_planning.errors import MoveItErrorCode, PlanningError
from arm_planning.planners.pilz.cartesian_limits import CartesianLimits
from arm_planning.planners.pilz.planner import PilzPlanner
from arm_planning.planners.pilz.sequence import SequenceItem, plan_sequence
from arm_planning.request import PlanRequest
from arm_planning.timing.driven_spline import limit_violation

PLANNER = PilzPlanner(MODEL, CartesianLimits(0.1, 0.4, -0.4))
CORNER, DROP = np.array((0.0, 0.1, 0.0)), np.array((0.0, 0.0, -0.1))
LOW = CORNER + DROP
SIDE = asked("LIN", pose_goal(CORNER))
DOWN = asked("LIN", pose_goal(LOW))
BACK = asked("LIN", pose_goal((0.0, 0.0, -0.1)))
LIMITS = MODEL.group("arm").limits


def planned(*items):
    return plan_sequence(PLANNER, [SequenceItem(*item) for item in items], READY)


def refused(*items):
    with pytest.raises(PlanningError) as error:
        planned(*items)
    return error.value.code, str(error.value)


def test_without_radii_motions_follow_one_another():
    (found,) = planned((SIDE, 0.0), (DOWN, 0.0))
    single = [PLANNER.plan(SIDE, READY).duration_s]
    assert found.duration_s == pytest.approx(2 * single[0], rel=0.05)
    way = tip_offsets(found, 2000)
    assert np.linalg.norm(way - CORNER, axis=1).min() < 1e-4
    assert way[-1] == pytest.approx(LOW, abs=1e-5)
    assert (np.diff(found.times_s) > 0.0).all()


def test_a_blend_leaves_out_the_point_between_and_is_faster():
    (stopping,), (found,) = planned((SIDE, 0.0), (DOWN, 0.0)), planned((SIDE, 0.03), (DOWN, 0.0))
    assert found.duration_s < stopping.duration_s - 0.1
    distances = np.linalg.norm(tip_offsets(found, 2000) - CORNER, axis=1)
    assert 3e-3 < distances.min() < 0.03
    assert limit_violation(found, LIMITS) == ""


def test_a_blend_stays_within_its_radius_and_in_the_plane_of_its_lines():
    (found,) = planned((SIDE, 0.03), (DOWN, 0.0))
    way = tip_offsets(found, 2000)
    assert np.abs(way[:, 0]).max() < 2e-4
    outside = np.linalg.norm(way - CORNER, axis=1) > 0.0302
    off_lines = np.minimum(np.abs(way[:, 2]), np.abs(way[:, 1] - 0.1))
    assert off_lines[outside].max() < 2e-4


def test_several_blends_make_one_motion():
    (found,) = planned((SIDE, 0.03), (DOWN, 0.03), (BACK, 0.0))
    speeds = np.linalg.norm(np.diff(tip_offsets(found, 500), axis=0), axis=1)
    assert speeds[20:-20].min() > 0.1 * speeds.max()
    assert limit_violation(found, LIMITS) == ""


def test_a_line_and_a_point_to_point_motion_blend():
    turn = asked("PTP", joint_goal(*(START + 0.3)))
    (found,) = planned((SIDE, 0.02), (turn, 0.0))
    assert found.positions[-1] == pytest.approx(START + 0.3)
    assert limit_violation(found, LIMITS) == ""


def test_the_second_motion_starts_where_the_first_ends():
    first, second = joint_goal(0.5, names=("j1",)), joint_goal(0.5, names=("j2",))
    (found,) = planned((asked("PTP", first), 0.0), (asked("PTP", second), 0.0))
    assert found.positions[-1, :2] == pytest.approx([0.5, 0.5])


def test_each_run_of_a_group_is_a_trajectory():
    shoulder = PlanRequest("shoulder", (joint_goal(0.6, names=("j1",)),), planner="PTP")
    found = planned((SIDE, 0.0), (shoulder, 0.0), (asked("PTP", joint_goal(*START)), 0.0))
    assert [len(each.joints) for each in found] == [6, 2, 6]
    assert found[2].positions[0, 0] == pytest.approx(0.6)


def test_different_groups_are_not_blended(caplog):
    shoulder = PlanRequest("shoulder", (joint_goal(0.6, names=("j1",)),), planner="PTP")
    found = planned((SIDE, 0.01), (shoulder, 0.0))
    assert len(found) == 2
    assert "Blend radii set to zero: groups 'arm' and 'shoulder' differ" in caplog.text


def test_no_motions_make_no_trajectory():
    assert planned() == ()


@pytest.mark.parametrize(
    ("items", "code", "sentence"),
    [
        (
            [(SIDE, -0.1), (DOWN, 0.0)],
            "INVALID_MOTION_PLAN",
            "All blending radii MUST be non negative; that of motion 0 is -0.1",
        ),
        ([(SIDE, float("nan")), (DOWN, 0.0)], "INVALID_MOTION_PLAN", "MUST be non negative"),
        ([(SIDE, 0.0), (DOWN, 0.1)], "INVALID_MOTION_PLAN", "last blending radius must be zero"),
        (
            [(SIDE, 0.06), (DOWN, 0.06), (BACK, 0.0)],
            "INVALID_MOTION_PLAN",
            "Overlapping blend radii between command [0] and [1].",
        ),
        (
            [(SIDE, 0.0), (asked("LIN", pose_goal((0, 0, 0)), start=READY), 0.0)],
            "INVALID_ROBOT_STATE",
            "Only the first request of group 'arm' may have a start state",
        ),
        (
            [(SIDE, 0.0), (asked("LIN", pose_goal((0, 3.0, 0))), 0.0)],
            "NO_IK_SOLUTION",
            "motion 1 of the sequence: LIN stops",
        ),
    ],
)
def test_sequences_that_cannot_be_driven(items, code, sentence):
    found, message = refused(*items)
    assert found is MoveItErrorCode[code]
    assert sentence in message


def test_a_radius_as_long_as_the_motion_before_is_refused():
    long = asked("LIN", pose_goal(LOW + DROP))
    code, message = refused((SIDE, 0.11), (long, 0.0))
    assert code is MoveItErrorCode.INVALID_MOTION_PLAN
    assert "stays within its radius of 0.11 m" in message


def test_an_arm_of_seven_joints_ends_on_the_second_motion():
    names = tuple(f"j{number}" for number in range(7))
    axes = ("0 0 1", "0 1 0", "0 0 1", "0 1 0", "0 0 1", "0 1 0", "0 0 1")
    arm = robot(
        link("base"),
        *(link(f"l{number}") for number in range(7)),
        *(
            joint(name, f"l{n - 1}" if n else "base", f"l{n}", xyz="0 0 0.2", axis=axes[n])
            for n, name in enumerate(names)
        ),
    )
    planner = PilzPlanner(model_of(arm, arm=(names, "l6")), CartesianLimits(0.1, 0.4, -0.4))
    start = dict(zip(names, (0.1, 0.5, 0.2, 1.0, 0.1, 0.6, 0.0), strict=True))
    tip = planner.kinematics("arm", "l6", start).tip_pose(list(start.values()))
    requests = [
        PlanRequest("arm", (pose_goal(offset, tip.rotation, at=tip),), planner="LIN")
        for offset in ((0.0, 0.08, 0.0), (0.0, 0.08, 0.08))
    ]
    (apart,) = plan_sequence(planner, [SequenceItem(each) for each in requests], start)
    items = [SequenceItem(requests[0], 0.03), SequenceItem(requests[1])]
    (found,) = plan_sequence(planner, items, start)
    assert found.positions[-1] == pytest.approx(apart.positions[-1], abs=1e-9)
    assert found.duration_s < apart.duration_s
