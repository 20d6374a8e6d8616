"""The controller as a whole: the cases of upstream's test_trajectory_controller.cpp."""

import numpy as np
import pytest

from arm_control.controllers.controller import ControllerContext
from arm_control.controllers.joint_trajectory.controller import JointTrajectoryController
from arm_control.controllers.joint_trajectory.goals import ErrorCode, GoalOutcome
from arm_control.errors import ControllerError

START = (1.1, 2.1, 3.1)
POINTS = [[3.3, 4.4, 6.6], [7.7, 8.8, 9.9], [10.10, 11.11, 12.12]]
THREE_POINTS = [(0.25 * (i + 1), point) for i, point in enumerate(POINTS)]


def gains(**values: float) -> dict[str, float]:
    return {f"gains__j{i}__{name}": value for i in range(3) for name, value in values.items()}


class TestActivation:
    def test_hold_on_startup(self, make_rig, interfaces):
        commands, states = interfaces
        rig = make_rig(commands=commands, states=states, positions=START, **gains(p=10.0))
        rig.run(0.25)

        for kind in commands:
            expected = list(START) if kind == "position" else [0.0, 0.0, 0.0]
            assert rig.commanded(kind).tolist() == expected

    def test_hw_states_has_offset_first_controller_start(self, make_rig):
        rig = make_rig(positions=START)
        rig.tick()

        assert rig.commanded().tolist() == list(START), "no command before: measured positions"

    def test_hw_states_has_offset_later_controller_start(self, make_rig):
        rig = make_rig(positions=START, activate=False)
        rig.command_before([3.1, 4.1, 5.1])
        rig.activate()
        rig.tick()

        assert rig.commanded().tolist() == [3.1, 4.1, 5.1]

    def test_the_last_command_does_not_count_where_that_is_unwanted(self, make_rig):
        rig = make_rig(
            positions=START,
            activate=False,
            set_last_command_interface_value_as_state_on_activation=False,
        )
        rig.command_before([3.1, 4.1, 5.1])
        rig.activate()
        rig.tick()

        assert rig.commanded().tolist() == list(START)

    def test_one_unknown_command_makes_all_of_them_count_for_nothing(self, make_rig):
        rig = make_rig(positions=START, commands=("position", "velocity"), activate=False)
        rig.command_before([3.1, 4.1, 5.1])
        rig.command_before([0.0, np.nan, 0.0], "velocity")
        rig.activate()
        rig.tick()

        assert rig.commanded().tolist() == list(START)

    def test_a_trajectory_of_the_last_activation_is_forgotten(self, make_rig):
        rig = make_rig()
        rig.trajectory([(1.0, [1.0, 1.0, 1.0])])
        rig.deactivate()
        rig.activate()
        rig.run(2.0)

        assert rig.commanded().tolist() == [0.0, 0.0, 0.0]

    def test_a_bad_robot_description_prevents_loading(self):
        with pytest.raises(ControllerError, match="robot description"):
            JointTrajectoryController(ControllerContext("jtc", 100, "<robot"))

    def test_open_loop_control_is_deprecated(self, make_rig, caplog):
        make_rig(open_loop_control=True)

        assert "interpolate_from_desired_state" in caplog.text


class TestDeactivation:
    def test_positions_stay(self, make_rig):
        rig = make_rig()
        rig.trajectory([(1.0, [1.0, 2.0, 3.0])])
        rig.run(0.5)
        before = rig.commanded()
        rig.deactivate()

        assert rig.commanded().tolist() == before.tolist()

    def test_everything_else_becomes_zero(self, make_rig, interfaces):
        commands, states = interfaces
        rig = make_rig(commands=commands, states=states, **gains(p=1.0))
        rig.moves = False
        rig.trajectory([(1.0, [1.0, 2.0, 3.0], [0.0] * 3, [0.0] * 3)])
        rig.run(0.5)
        rig.deactivate()

        for kind in commands:
            if kind != "position":
                assert rig.commanded(kind).tolist() == [0.0, 0.0, 0.0]

    def test_requests_are_silently_dropped(self, make_rig):
        rig = make_rig()
        rig.deactivate()
        rig.trajectory([(1.0, [1.0, 2.0, 3.0])])
        rig.activate()
        rig.run(1.0)

        assert rig.commanded().tolist() == [0.0, 0.0, 0.0]


class TestFollowing:
    def test_correct_initialization_and_three_points(self, make_rig, interfaces):
        commands, states = interfaces
        rig = make_rig(commands=commands, states=states, positions=START)
        rig.moves = False
        rig.trajectory(THREE_POINTS)
        rig.tick()
        rig.run(0.25)
        assert rig.sink.state.reference[0] == pytest.approx(POINTS[0])

        rig.run(0.5)
        assert rig.sink.state.reference[0].tolist() == POINTS[2]
        if "position" in commands:
            assert rig.commanded().tolist() == POINTS[2]

    def test_test_jumbled_joint_order(self, make_rig):
        rig = make_rig()
        rig.trajectory([(0.25, [2.0, 3.0, 1.0])], joints=("j1", "j2", "j0"))
        rig.run(0.5)

        assert rig.measured().tolist() == [1.0, 2.0, 3.0]

    def test_test_partial_joint_list(self, make_rig):
        rig = make_rig(positions=START, allow_partial_joints_goal=True)
        rig.trajectory([(0.25, [5.0, 4.0])], joints=("j2", "j0"))
        rig.run(0.5)

        assert rig.measured().tolist() == [4.0, START[1], 5.0]

    def test_a_partial_list_holds_what_is_commanded_not_what_is_measured(self, make_rig):
        rig = make_rig(allow_partial_joints_goal=True)
        rig.trajectory([(0.25, [1.0, 1.0, 1.0])])
        rig.run(0.5)
        rig.moves = False
        rig.place([0.9, 0.9, 0.9])
        rig.trajectory([(0.25, [5.0])], joints=("j2",))
        rig.run(0.5)

        assert rig.commanded().tolist() == [1.0, 1.0, 5.0]

    def test_a_partial_list_holds_what_is_measured_without_position_commands(self, make_rig):
        rig = make_rig(
            commands=("velocity",), positions=START, allow_partial_joints_goal=True, **gains(p=1.0)
        )
        rig.trajectory([(0.25, [5.0], [0.0])], joints=("j2",))
        rig.run(0.5)

        assert rig.sink.state.reference[:3, 0].tolist() == [START[0], 0.0, 0.0]

    def test_test_partial_joint_list_not_allowed(self, make_rig, make_request):
        rig = make_rig()
        refusal = rig.controller.submit_trajectory(make_request([(0.25, [5.0])], ["j2"]))
        rig.run(0.5)

        assert refusal is not None
        assert rig.commanded().tolist() == [0.0, 0.0, 0.0]

    def test_missing_positions_message_accepted(self, make_rig):
        rig = make_rig(allow_integration_in_goal_trajectories=True)
        rig.trajectory([(1.0, [], [1.0, 1.0, 1.0]), (2.0, [], [0.0, 0.0, 0.0])])
        rig.run(2.1)

        assert rig.measured() == pytest.approx([1.0, 1.0, 1.0])

    def test_test_trajectory_replace(self, make_rig):
        rig = make_rig(allow_partial_joints_goal=True)
        rig.trajectory([(0.5, [2.0, 3.0, 4.0])])
        rig.run(0.6)
        rig.trajectory([(0.5, [1.5])], joints=("j0",))
        rig.run(0.6)

        assert rig.measured().tolist() == [1.5, 3.0, 4.0]

    def test_a_running_trajectory_is_replaced(self, make_rig):
        rig = make_rig()
        rig.trajectory([(1.0, [2.0, 3.0, 4.0])])
        rig.run(0.5)
        rig.trajectory([(0.5, [0.0, 0.0, 0.0])])
        rig.run(0.6)

        assert rig.measured().tolist() == [0.0, 0.0, 0.0]

    def test_test_ignore_old_trajectory(self, make_rig, make_request):
        rig = make_rig()
        rig.trajectory([(0.5, [2.0, 3.0, 4.0]), (1.0, [4.0, 5.0, 6.0])])
        rig.run(0.5)
        old = make_request([(0.5, [-1.0, -2.0, -3.0])], stamp_s=rig.time_s - 0.6)
        refusal = rig.controller.submit_trajectory(old)
        rig.run(0.6)

        assert "ends in the past" in refusal.message
        assert rig.measured().tolist() == [4.0, 5.0, 6.0]

    @pytest.mark.parametrize("reactivated", [False, True])
    def test_an_old_trajectory_before_the_first_update_is_ignored_by_it(
        self, make_rig, caplog, reactivated
    ):
        rig = make_rig(positions=START)
        if reactivated:
            rig.tick()
            rig.deactivate()
            rig.activate()
        rig.trajectory([(0.5, [-1.0, -2.0, -3.0])], stamp_s=rig.time_s - 0.6)
        # Somebody pauses the simulation, and clients are served all the same.
        rig.controller.serve_requests()
        rig.run(0.6)

        assert caplog.text.count("that ends in the past") == 1
        assert rig.commanded().tolist() == list(START)

    def test_it_does_not_end_the_hold_of_the_last_command(self, make_rig):
        rig = make_rig(positions=START, activate=False)
        rig.command_before([1.2, 2.2, 3.2])
        rig.activate()
        rig.trajectory([(0.5, [-1.0, -2.0, -3.0])], stamp_s=rig.time_s - 0.6)
        rig.tick()

        assert rig.commanded().tolist() == [1.2, 2.2, 3.2]

    def test_a_goal_that_is_old_at_the_first_update_is_aborted_with_the_reason(self, make_rig):
        rig = make_rig(positions=START)
        rig.goal([(0.5, [-1.0, -2.0, -3.0])], stamp_s=rig.time_s - 0.6)
        assert rig.result is None
        rig.tick()

        assert rig.result.outcome is GoalOutcome.ABORTED
        assert rig.result.code is ErrorCode.INVALID_GOAL
        assert rig.result.message == (
            "Received trajectory with non-zero start time (9.400000) that ends in the past "
            "(9.900000)"
        )
        assert rig.commanded().tolist() == list(START)

    def test_before_the_first_update_one_that_has_not_ended_yet_is_followed(self, make_rig):
        rig = make_rig()
        rig.goal([(0.5, [1.0, 2.0, 3.0]), (1.0, [2.0, 4.0, 6.0])], stamp_s=rig.time_s - 0.6)
        rig.run(0.5)

        assert rig.measured().tolist() == [2.0, 4.0, 6.0]
        assert rig.result.outcome is GoalOutcome.SUCCEEDED

    def test_test_ignore_partial_old_trajectory(self, make_rig):
        rig = make_rig()
        rig.trajectory([(0.5, [2.0, 3.0, 4.0]), (1.0, [4.0, 5.0, 6.0])])
        rig.run(0.5)
        rig.trajectory(
            [(0.5, [-1.0, -2.0, -3.0]), (1.0, [-2.0, -4.0, -6.0])], stamp_s=rig.time_s - 0.6
        )
        rig.tick()
        # 0.11 s past the first point: it is not gone back to
        assert rig.sink.state.reference[0] == pytest.approx([-1.22, -2.44, -3.66])

        rig.run(0.5)
        assert rig.measured().tolist() == [-2.0, -4.0, -6.0]

    def test_a_trajectory_for_the_future_moves_at_once(self, make_rig):
        rig = make_rig()
        rig.trajectory([(1.0, [1.0, 2.0, 3.0])], stamp_s=rig.time_s + 1.01)
        rig.tick()
        rig.run(1.0)
        assert rig.measured() == pytest.approx([0.505, 1.01, 1.515])

        rig.run(1.0)
        assert rig.measured().tolist() == [1.0, 2.0, 3.0]

    def test_the_newest_of_several_trajectories_is_executed(self, make_rig):
        rig = make_rig()
        for value in range(5):
            rig.trajectory([(0.1, [value, value, value])])
        rig.run(0.2)

        assert rig.measured().tolist() == [4.0, 4.0, 4.0]

    def test_interpolation_method_none(self, make_rig):
        rig = make_rig(interpolation_method="none")
        rig.trajectory([(0.1, [1.0] * 3), (0.2, [2.0] * 3)])
        rig.run(0.1)
        assert rig.sink.state.reference[0].tolist() == [0.0, 0.0, 0.0]

        rig.tick()
        assert rig.sink.state.reference[0].tolist() == [2.0, 2.0, 2.0]

    def test_fewer_command_joints_than_joints(self, make_rig):
        rig = make_rig(command_joints=("j2", "j0"), positions=START)
        rig.trajectory([(0.1, [5.0, 6.0, 7.0])])
        rig.run(0.2)

        assert rig.command("j0/position") == 5.0
        assert np.isnan(rig.command("j1/position")), "not claimed, not touched"
        assert rig.command("j2/position") == 7.0
        assert np.isnan(rig.sink.state.output[0, 1])

    def test_a_reset_of_the_simulation_does_not_disturb(self, make_rig):
        rig = make_rig()
        rig.goal([(1.0, [1.0, 2.0, 3.0])])
        rig.run(0.5)
        rig.time_s = 0.0
        rig.run(0.6)

        assert rig.measured().tolist() == [1.0, 2.0, 3.0]
        assert rig.result is not None


class TestStartOfTrajectories:
    def test_test_jump_when_state_tracking_error_updated(self, make_rig):
        rig = make_rig()
        rig.trajectory([(1.0, [3.3, 4.4, 5.5])])
        rig.run(1.1)
        rig.moves = False
        rig.place([3.0, 4.4, 5.5])
        rig.trajectory([(1.0, [6.6, 8.8, 11.0])])
        rig.tick()

        assert rig.commanded()[0] == pytest.approx(3.0 + 3.6 * 0.01)

    @pytest.mark.parametrize("name", ["interpolate_from_desired_state", "open_loop_control"])
    def test_test_no_jump_when_state_tracking_error_not_updated(self, make_rig, name):
        rig = make_rig(**{name: True})
        rig.trajectory([(1.0, [3.3, 4.4, 5.5])])
        rig.run(1.1)
        rig.moves = False
        rig.place([3.0, 4.4, 5.5])
        rig.trajectory([(1.0, [6.6, 8.8, 11.0])])
        rig.tick()

        assert rig.commanded()[0] == pytest.approx(3.3 + 3.3 * 0.01)

    @pytest.mark.parametrize("first_s", [0.0, 0.005, 0.3])
    def test_replacement_without_a_step(self, make_rig, first_s):
        rig = make_rig(commands=("position", "velocity"), smooth_replacement_time=0.2)
        rig.trajectory([(1.0, [1.0] * 3)])
        rig.run(0.5)
        position, velocity = rig.commanded(), rig.commanded("velocity")
        rig.trajectory([(first_s, [0.0] * 3), (1.0, [-1.0] * 3)])
        rig.tick()

        assert velocity.min() > 1.0
        assert rig.commanded() == pytest.approx(position + 0.01 * velocity, abs=0.005)
        assert rig.commanded("velocity") == pytest.approx(velocity, abs=0.5)

    def test_a_smoothly_replaced_trajectory_still_arrives(self, make_rig):
        rig = make_rig(smooth_replacement_time=0.2)
        rig.goal([(1.0, [1.0, 2.0, 3.0])], "first")
        rig.run(0.5)
        rig.goal([(0.5, [0.0, 0.0, 0.0])], "second")
        rig.run(0.51)

        assert rig.sink.results["second"].code == 0
        assert rig.measured() == pytest.approx([0.0, 0.0, 0.0], abs=1e-12)

    def test_without_it_the_velocity_steps(self, make_rig):
        rig = make_rig(commands=("position", "velocity"))
        rig.trajectory([(1.0, [1.0] * 3)])
        rig.run(0.5)
        rig.trajectory([(0.5, [0.0] * 3)])
        before = rig.commanded("velocity")
        rig.tick()

        assert np.abs(rig.commanded("velocity") - before).min() > 1.9
