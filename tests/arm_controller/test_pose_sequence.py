"""Each pose has its turn: whether it is reached, and why not."""

import pytest

from arm_controller.joint_pose import AllowedRange, JointPose, PoseLimits, no_limits
from arm_controller.pose_sequence import Approach, PoseSequence

NAMES = ("j0", "j1")
GOAL = JointPose(NAMES, (1.0, -0.5))
HOME = {"j0": 0.0, "j1": 0.0}


def limits(velocity: float = 2.0) -> PoseLimits:
    return PoseLimits(tuple(AllowedRange(name, -3.0, 3.0, velocity, "rad") for name in NAMES))


def approach(allowed: PoseLimits | None = None, start: dict[str, float] | None = None) -> Approach:
    return Approach(
        GOAL,
        allowed or limits(),
        HOME if start is None else start,
        started_s=10.0,
        tolerance=0.02,
        timeout_s=5.0,
    )


@pytest.mark.parametrize(
    ("positions", "reached"),
    [
        ({"j1": -0.5, "j0": 1.0}, True),
        ({"j0": 1.015, "j1": -0.485, "grip": 7.0}, True),
        ({"j0": 1.021, "j1": -0.5}, False),
        ({"j0": 1.0}, False),
        ({"j0": 1.0, "j1": float("nan")}, False),
    ],
)
def test_is_reached_when_every_joint_is_within_the_tolerance(positions, reached):
    assert approach().is_reached(positions) is reached


def test_is_late_after_the_time_out():
    assert not approach().is_late(14.9)
    assert approach().is_late(15.0)


def test_setting_the_clock_back_restarts_the_time():
    way = approach()
    assert not way.is_late(2.0)
    assert not way.is_late(6.9)
    assert way.is_late(7.0)


def test_no_forecast_where_the_time_suffices():
    assert approach().forecast() is None


def test_forecasts_the_joint_that_is_too_slow():
    assert approach(limits(velocity=0.1)).forecast() == (
        "joint 'j0' needs at least 10.0 s at its velocity limit of 0.1 rad/s, "
        "and the timeout is 5 s (parameter timeout)"
    )


def test_a_shortfall_names_the_joint_that_is_farthest_off_and_its_error():
    said = approach().shortfall({"j0": 0.9, "j1": 0.0})
    assert said.startswith("joint 'j1' is at 0.0000, 0.5000 rad from -0.5000 (tolerance 0.02)")
    assert "joint 'j0' needs only 0.5 s" in said
    assert "another node commands the arm" in said


def test_a_shortfall_of_slow_joints_blames_their_limit():
    said = approach(limits(velocity=0.1)).shortfall({"j0": 0.5, "j1": -0.5})
    assert "needs at least 10.0 s" in said
    assert "another node" not in said


def test_a_shortfall_of_an_unknown_robot_makes_no_claim_on_time():
    said = approach(no_limits(NAMES)).shortfall(HOME)
    assert "takes" not in said
    assert "something is in its way" in said


def test_a_missing_joint_is_named_with_those_that_exist():
    said = approach(start={}).shortfall({"a": 0.0, "j0": 1.0})
    assert said == "no joint 'j1' in /joint_states, which has a, j0"


def test_silent_joint_states_are_reported():
    assert "/joint_states is silent" in approach(start={}).shortfall({})


def test_a_position_that_is_not_a_number_is_never_near_and_is_named():
    way = approach()
    positions = {"j0": float("nan"), "j1": -0.5}
    assert not way.is_reached(positions)
    assert "position of joint 'j0' in /joint_states is not a number" in way.shortfall(positions)


ONE_NAME = ("j0",)
LIMITS = no_limits(ONE_NAME)
POSES = tuple(JointPose(ONE_NAME, (value,)) for value in (0.5, 1.0, 0.0))


@pytest.fixture
def sequence() -> PoseSequence:
    return PoseSequence(POSES, tolerance=0.01, timeout_s=3.0)


def reach_all(sequence: PoseSequence) -> None:
    while (pose := sequence.waiting_pose) is not None:
        sequence.begin(LIMITS, {}, 0.0)
        sequence.on_positions({"j0": pose.positions[0]}, 0.5)


def test_goes_through_the_poses_in_order(sequence):
    assert sequence.waiting_pose == POSES[0]
    sequence.begin(LIMITS, {}, 0.0)
    assert sequence.waiting_pose is None
    assert sequence.on_positions({"j0": 0.2}, 1.0) is None
    assert sequence.on_positions({"j0": 0.5}, 2.0) == "Pose 1 of 3 reached after 2.0 s"
    assert sequence.waiting_pose == POSES[1]


def test_is_finished_when_all_are_reached(sequence):
    reach_all(sequence)
    assert sequence.finished
    assert sequence.missed == 0
    assert sequence.waiting_pose is None


def test_a_pose_that_is_late_is_counted_and_the_next_comes(sequence):
    sequence.begin(LIMITS, {"j0": 0.0}, 10.0)
    assert sequence.on_time({"j0": 0.1}, 12.9) is None
    said = sequence.on_time({"j0": 0.1}, 13.0)
    assert said is not None
    assert said.startswith("Pose 1 of 3 not reached within 3 s: joint 'j0' is at 0.1000")
    assert sequence.waiting_pose == POSES[1]
    reach_all(sequence)
    assert sequence.missed == 1


def test_a_refused_pose_is_counted_and_the_next_comes(sequence):
    sequence.refuse()
    assert sequence.waiting_pose == POSES[1]
    reach_all(sequence)
    assert sequence.missed == 1


def test_giving_up_counts_all_that_are_left(sequence):
    sequence.begin(LIMITS, {}, 0.0)
    sequence.on_positions({"j0": 0.5}, 1.0)
    sequence.begin(LIMITS, {}, 1.0)
    sequence.give_up()
    assert sequence.finished
    assert sequence.missed == 2
    assert sequence.count == 3


def test_nothing_happens_without_a_current_pose(sequence):
    assert sequence.on_positions({"j0": 0.5}, 1.0) is None
    assert sequence.on_time({"j0": 0.5}, 100.0) is None


def test_the_next_pose_waits_for_the_pause_even_if_the_last_is_reached():
    sequence = PoseSequence([GOAL, GOAL], tolerance=0.02, timeout_s=30.0, pause_s=10.0)
    assert not sequence.is_pausing(100.0)
    sequence.begin(limits(), HOME, 100.0)
    assert sequence.on_positions({"j0": 1.0, "j1": -0.5}, 101.0) is not None
    assert sequence.waiting_pose is GOAL
    assert sequence.is_pausing(109.9)
    assert not sequence.is_pausing(110.0)


def test_setting_the_clock_back_restarts_the_pause():
    sequence = PoseSequence([GOAL, GOAL], tolerance=0.02, timeout_s=30.0, pause_s=10.0)
    sequence.begin(limits(), HOME, 100.0)
    assert sequence.is_pausing(5.0)
    assert not sequence.is_pausing(15.0)
