"""Which trajectories are refused, in which order, with which words."""

from dataclasses import replace
from typing import Any

import numpy as np
import pytest

from arm_control.controllers.joint_trajectory.goals import ErrorCode
from arm_control.controllers.joint_trajectory.parameters import JointTrajectoryParameters
from arm_control.controllers.joint_trajectory.trajectory import TrajectoryPoint, TrajectoryRequest
from arm_control.controllers.joint_trajectory.validation import find_fault

JOINTS = ("j0", "j1", "j2")
PARAMETERS = JointTrajectoryParameters(joints=JOINTS)
PARTIAL = replace(PARAMETERS, allow_partial_joints_goal=True)
INTEGRATING = replace(PARAMETERS, allow_integration_in_goal_trajectories=True)
GOOD_POINT = TrajectoryPoint(0.25, [1.0, 2.0, 3.0], [-1.0, -2.0, -3.0])
END = TrajectoryPoint(0.5, [1.0, 2.0, 3.0], [0.0, 0.0, 0.0])
GOOD = TrajectoryRequest(JOINTS, [GOOD_POINT, END])


def message(
    request: TrajectoryRequest, parameters: JointTrajectoryParameters = PARAMETERS, **options: Any
) -> str:
    fault = find_fault(request, parameters, **options)
    return fault.message if fault else ""


def with_first(**fields: Any) -> TrajectoryRequest:
    return replace(GOOD, points=[replace(GOOD_POINT, **fields), END])


def test_a_good_trajectory_has_no_fault():
    assert find_fault(GOOD, PARAMETERS) is None


class TestInvalidMessage:
    """Upstream's invalid_message and similar tests."""

    def test_a_subset_of_the_joints(self):
        fault = find_fault(replace(GOOD, joint_names=["j0"]), PARAMETERS)

        assert fault is not None
        assert fault.message == "Joints on incoming trajectory don't match the controller joints."
        assert fault.code is ErrorCode.INVALID_JOINTS

    def test_no_joints_at_all_where_a_subset_is_allowed(self):
        assert message(replace(GOOD, joint_names=[]), PARTIAL) == (
            "Empty joint names on incoming trajectory."
        )

    def test_no_points(self):
        fault = find_fault(replace(GOOD, points=[]), PARAMETERS)

        assert fault is not None
        assert fault.message == "Empty trajectory received."
        assert fault.code is ErrorCode.INVALID_GOAL

    def test_an_unknown_joint(self):
        fault = find_fault(replace(GOOD, joint_names=["j0", "j9", "j2"]), PARAMETERS)

        assert fault is not None
        assert fault.message == "Incoming joint j9 doesn't match the controller's joints."
        assert fault.code is ErrorCode.INVALID_JOINTS

    @pytest.mark.parametrize("size", [0, 1, 2, 4])
    def test_positions_of_another_size(self, size):
        assert message(with_first(positions=[0.0] * size)) == (
            f"Mismatch between joint_names size (3) and positions ({size}) at point #0."
        )

    @pytest.mark.parametrize("field", ["velocities", "accelerations"])
    @pytest.mark.parametrize("size", [1, 4])
    def test_derivatives_of_another_size(self, field, size):
        assert message(with_first(**{field: [0.0] * size})) == (
            f"Mismatch between joint_names size (3) and {field} ({size}) at point #0."
        )

    def test_efforts_of_another_size(self):
        taking_efforts = replace(PARAMETERS, command_interfaces=("effort",))

        assert message(with_first(effort=[1.0]), taking_efforts) == (
            "Mismatch between joint_names size (3) and effort (1) at point #0."
        )

    def test_efforts_without_the_interface(self):
        assert message(with_first(effort=[1.0, 1.0, 1.0])) == (
            "Trajectories with effort fields are only supported for controllers using the "
            "'effort' command interface."
        )

    def test_times_that_do_not_increase(self):
        assert message(replace(GOOD, points=[END, END])) == (
            "Time between points 0 and 1 is not strictly increasing, it is 0.500000 and 0.500000 "
            "respectively"
        )

    def test_a_point_with_nothing_in_it(self):
        empty = with_first(positions=[], velocities=[])

        assert message(empty, INTEGRATING) == (
            "The given trajectory has no position, velocity, or acceleration points."
        )


def test_the_first_point_may_be_due_at_once():
    assert find_fault(with_first(time_from_start_s=0.0), PARAMETERS) is None


def test_a_subset_is_taken_where_that_is_allowed():
    point = TrajectoryPoint(1.0, [1.0])

    assert find_fault(TrajectoryRequest(["j2"], [point]), PARTIAL) is None


@pytest.mark.parametrize(
    "fields",
    [{"positions": []}, {"positions": [], "velocities": [], "accelerations": [1.0, 1.0, 1.0]}],
)
def test_missing_positions_message_accepted(fields):
    assert find_fault(with_first(**fields), INTEGRATING) is None


class TestVelocityAtTheEnd:
    moving = TrajectoryRequest(JOINTS, [TrajectoryPoint(0.25, [1.0] * 3, [0.0, -2.0, 0.0])])

    def test_is_refused(self):
        assert message(self.moving) == (
            "Velocity of last trajectory point of joint j1 is not zero: -2.000000000000000"
        )

    def test_is_taken_where_that_is_allowed(self):
        assert (
            find_fault(
                self.moving, replace(PARAMETERS, allow_nonzero_velocity_at_trajectory_end=True)
            )
            is None
        )

    def test_may_be_a_rounding_error(self):
        still = TrajectoryRequest(JOINTS, [TrajectoryPoint(0.25, [1.0] * 3, [1e-8] * 3)])

        assert find_fault(still, PARAMETERS) is None


class TestStamp:
    def test_a_trajectory_that_is_over_is_refused(self):
        assert message(replace(GOOD, stamp_s=9.0), now_s=10.0) == (
            "Received trajectory with non-zero start time (9.000000) that ends in the past "
            "(9.500000)"
        )

    def test_one_that_began_in_the_past_is_taken(self):
        assert find_fault(replace(GOOD, stamp_s=9.8), PARAMETERS, now_s=10.0) is None

    def test_no_stamp_means_now(self):
        assert find_fault(GOOD, PARAMETERS, now_s=10.0) is None


class TestBeyondUpstream:
    @pytest.mark.parametrize("value", [np.nan, np.inf, -np.inf])
    @pytest.mark.parametrize("field", ["positions", "velocities", "accelerations"])
    def test_numbers_that_are_not_finite_are_refused(self, field, value):
        fault = find_fault(with_first(**{field: [0.0, value, 0.0]}), PARAMETERS)

        assert fault is not None
        assert fault.message == (
            f"The {field} of joint j1 at point #0 are not finite: {float(value)}."
        )
        assert fault.code is ErrorCode.INVALID_GOAL

    @pytest.mark.parametrize("field", ["positions", "velocities", "accelerations"])
    def test_numbers_that_polynomials_could_overflow_with_are_refused(self, field):
        assert message(with_first(**{field: [0.0, -1e300, 0.0]})) == (
            f"The {field} of joint j1 at point #0 are too large: -1e+300."
        )

    def test_efforts_that_are_not_finite_are_refused(self):
        taking_efforts = replace(PARAMETERS, command_interfaces=("effort",))

        assert "effort" in message(with_first(effort=[0.0, 0.0, np.nan]), taking_efforts)

    def test_a_velocity_at_the_end_that_is_not_a_number_is_refused(self):
        end = replace(END, velocities=[0.0, np.nan, 0.0])

        assert "not finite" in message(replace(GOOD, points=[GOOD_POINT, end]))

    def test_a_joint_named_twice_is_refused(self):
        fault = find_fault(replace(GOOD, joint_names=["j0", "j1", "j0"]), PARAMETERS)

        assert fault is not None
        assert fault.message == "Incoming joint j0 is named more than once."
        assert fault.code is ErrorCode.INVALID_JOINTS

    @pytest.mark.parametrize("time_s", [-0.1, np.nan, np.inf])
    def test_a_first_point_at_no_usable_time_is_refused(self, time_s):
        assert "first point" in message(with_first(time_from_start_s=time_s))

    @pytest.mark.parametrize("time_s", [np.nan, np.inf])
    def test_a_later_point_at_no_usable_time_is_refused(self, time_s):
        late = replace(END, time_from_start_s=time_s)

        assert "strictly increasing" in message(replace(GOOD, points=[GOOD_POINT, late]))

    def test_an_invalid_stamp_is_refused(self):
        assert "must be finite" in message(replace(GOOD, stamp_s=np.nan))


@pytest.mark.parametrize(
    ("spoil", "begin"),
    [
        (lambda r: replace(r, joint_names=["j0"]), "Joints on incoming"),
        (lambda r: replace(r, joint_names=["x", "j1", "j2"]), "Incoming joint x"),
        (lambda r: r, "Velocity of last"),
        (lambda r: _last(r, velocities=[]), "Received trajectory"),
        (lambda r: replace(_last(r, velocities=[]), stamp_s=0.0), "Time between"),
    ],
)
def test_the_first_fault_is_reported(spoil, begin):
    worst = TrajectoryRequest(
        JOINTS,
        [TrajectoryPoint(0.5, [np.nan]), TrajectoryPoint(0.5, [1.0], [1.0] * 3, (), [1.0])],
        stamp_s=1.0,
    )

    assert message(spoil(worst), now_s=10.0).startswith(begin)


def _last(request: TrajectoryRequest, **fields: Any) -> TrajectoryRequest:
    return replace(request, points=[request.points[0], replace(request.points[-1], **fields)])
