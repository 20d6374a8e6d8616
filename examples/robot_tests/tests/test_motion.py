"""The decisions, on the simulated arm without ROS: some milliseconds per test."""

import pytest
from patrol.motion import POSES, STUCK_AFTER_S, Patrol

pytestmark = pytest.mark.arm_sim(robot="arm", arguments={"camera": "none"})


@pytest.fixture
def patrol(arm_sim):
    """Return a patrol that the simulation runs: one decision in each control period."""
    deciding = Patrol()

    def run(seconds, until=lambda: False):
        def decide():
            command = deciding.command(arm_sim.time_s, arm_sim.joints.position)
            if command is not None:
                arm_sim["position_controller"].command(command)
            return until()

        return arm_sim.run_until(decide, timeout_s=seconds)

    deciding.run = run
    return deciding


def test_it_visits_its_poses(arm_sim, patrol):
    assert patrol.run(10.0, until=lambda: patrol.visited == 4)
    arm_sim.assert_never_exceeds(velocity=2.1)
    arm_sim.assert_no_contact()


def test_lost_commands_only_cost_time(arm_sim, patrol):
    with arm_sim.faults.messages_dropped("position_controller", fraction=0.5, seed=1):
        assert patrol.run(10.0, until=lambda: patrol.visited == 2)


def test_it_notices_a_stuck_joint_and_goes_on_afterwards(arm_sim, patrol):
    with arm_sim.faults.joint_stalled("j1"):
        assert patrol.run(STUCK_AFTER_S + 2.0, until=lambda: patrol.is_stuck)
        assert patrol.visited == 0
    assert patrol.run(10.0, until=lambda: patrol.visited == 2)
    assert not patrol.is_stuck


def test_it_sends_nothing_for_a_state_that_is_not_a_number():
    assert Patrol().command(0.0, [float("nan"), 0.0, 0.0, 0.0]) is None


def test_a_pose_is_within_reach(arm_sim):
    for pose in POSES:
        arm_sim["position_controller"].command(pose)
        arm_sim.assert_reaches(pose, within_s=3.0, hold_s=0.1)
