"""Each pose has its turn."""

import pytest

from arm_controller.joint_limits import no_limits
from arm_controller.pose import JointPose
from arm_controller.pose_sequence import PoseSequence

NAMES = ("j0",)
LIMITS = no_limits(NAMES)
POSES = tuple(JointPose(NAMES, (value,)) for value in (0.5, 1.0, 0.0))


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


def test_nothing_happens_while_no_pose_is_under_way(sequence):
    assert sequence.on_positions({"j0": 0.5}, 1.0) is None
    assert sequence.on_time({"j0": 0.5}, 100.0) is None
