"""The opt-in checks against the limits of the robot description."""

from collections.abc import Callable
from typing import Any

import pytest

LIMIT = '<limit lower="-1.0" upper="2.0" effort="9" velocity="1.5"/>'


@pytest.fixture
def fault(make_rig, make_request, robot_description) -> Callable[..., str]:
    """Say why a trajectory is refused with these checks; empty where it is not."""

    def find(
        points: list[Any],
        checks: tuple[str, ...] = ("position", "velocity"),
        joint_type: str = "revolute",
        **options: Any,
    ) -> str:
        joints = options.pop("joints", ("j0", "j1", "j2"))
        rig = make_rig(
            robot_description=robot_description(joint_type, LIMIT),
            **{f"check_{check}_limits": True for check in checks},
            **options,
        )
        refusal = rig.controller.check_goal(make_request(points, joints))
        return refusal.message if refusal else ""

    return find


def test_without_checks_anything_goes(fault):
    assert fault([(0.1, [9.0, 9.0, 9.0])], checks=()) == ""


def test_a_point_outside_the_position_limits(fault):
    message = fault([(10.0, [0.0, 2.1, 0.0])])

    assert message.startswith("The trajectory takes joint j1 to 2.")
    assert "outside its limits [-1.000000, 2.000000]" in message
    assert message.endswith("s after its start.")


def test_a_point_at_the_limit_is_inside(fault):
    assert fault([(10.0, [2.0, -1.0, 0.0])]) == ""


def test_a_spline_that_overshoots_between_the_points(fault):
    points = [(5.0, [0.0, 1.9, 0.0], [0.0, 1.0, 0.0]), (6.0, [0.0, 1.9, 0.0], [0.0, -1.0, 0.0])]

    assert "joint j1" in fault([*points, (12.0, [0.0] * 3, [0.0] * 3)])


def test_a_first_point_too_far_for_its_time(fault):
    message = fault([(1.0, [0.0, 0.0, 1.6])])

    assert message.startswith("The trajectory moves joint j2 at 1.600000, above its velocity")


def test_a_stamp_before_the_first_update_is_judged_by_it(make_rig, robot_description):
    rig = make_rig(
        robot_description=robot_description("revolute", LIMIT), check_velocity_limits=True
    )
    rig.goal([(1.0, [0.0, 0.0, 1.6])], stamp_s=rig.time_s)
    rig.tick()

    assert rig.result.message.startswith("The trajectory moves joint j2 at 1.616162, above its")
    assert rig.commanded().tolist() == [0.0, 0.0, 0.0]


def test_a_velocity_above_the_limit(fault):
    points = [(5.0, [0.0, 0.0, 0.0], [1.6, 0.0, 0.0]), (10.0, [1.0, 0.0, 0.0], [0.0, 0.0, 0.0])]

    assert "joint j0" in fault(points)


def test_each_check_is_enabled_separately(fault):
    too_fast, too_far = [(0.1, [1.0, 0.0, 0.0])], [(10.0, [3.0, 0.0, 0.0])]

    assert fault(too_fast, ("position",)) == ""
    assert fault(too_far, ("velocity",)) == ""


def test_positions_that_are_integrated_count(fault):
    there, stop = [1.0, 0.0, 0.0], [0.0, 0.0, 0.0]
    message = fault(
        [(1.0, [], there), (3.0, [], stop), (5.0, [], there), (6.0, [], stop)],
        allow_integration_in_goal_trajectories=True,
    )

    assert "joint j0 to" in message


class TestAJointBeyondItsLimit:
    """j1 rests where gravity, or its noise, has taken it: 0.1 past the upper limit."""

    beyond = (0.0, 2.1, 0.0)

    @pytest.mark.parametrize("target", [2.0, 2.05, 2.1])
    def test_may_stay_or_come_back(self, fault, target):
        assert fault([(5.0, [0.0, target, 0.0])], positions=self.beyond) == ""

    def test_leaves_the_others_their_goals(self, fault):
        partial = {"joints": ("j0",), "allow_partial_joints_goal": True}
        assert fault([(5.0, [1.0])], positions=self.beyond, **partial) == ""

    def test_may_be_held_where_it_was_commanded_to(self, make_rig, make_request, robot_description):
        rig = make_rig(
            robot_description=robot_description("revolute", LIMIT),
            positions=self.beyond,
            check_position_limits=True,
            allow_partial_joints_goal=True,
        )
        rig.tick()
        rig.place([0.0, 2.09, 0.0])
        rig.moves = False
        rig.tick()

        assert rig.controller.check_goal(make_request([(5.0, [1.0])], ["j0"])) is None

    @pytest.mark.parametrize("time_s", [0.0, 5.0])
    def test_may_not_go_further(self, fault, time_s):
        message = fault([(time_s, [0.0, 2.2, 0.0])], ("position",), positions=self.beyond)

        assert message.startswith("The trajectory takes joint j1 to 2.")
        assert "outside its limits [-1.000000, 2.000000]" in message

    def test_nor_beyond_the_other_limit(self, fault):
        assert "joint j1 to -1." in fault([(9.0, [0.0, -1.1, 0.0])], positions=self.beyond)


def test_joints_not_named_count_where_they_are(fault):
    assert fault([(10.0, [1.0])], joints=("j1",), allow_partial_joints_goal=True) == ""


def test_continuous_joints_have_no_position_limits(fault):
    assert fault([(10.0, [6.0, 6.0, 6.0])], joint_type="continuous") == ""


def test_without_a_robot_description_there_are_no_limits(make_rig, make_request):
    rig = make_rig(check_position_limits=True, check_velocity_limits=True)

    assert rig.controller.check_goal(make_request([(0.1, [9.0, 9.0, 9.0])])) is None


@pytest.fixture
def violations(make_rig, robot_description, caplog) -> Callable[..., list[str]]:
    """Return the log of a goal that is accepted without checks."""

    def find(
        points: list[Any], joint_type: str = "revolute", joints: Any = ("j0", "j1", "j2"), **o: Any
    ) -> list[str]:
        rig = make_rig(robot_description=robot_description(joint_type, LIMIT), **o)
        rig.goal(points, joints=joints)
        rig.tick(3)
        return [r.getMessage() for r in caplog.records if r.levelname == "WARNING"]

    return find


def test_a_goal_that_is_too_fast_for_a_joint_is_executed_with_one_warning(violations):
    assert violations([(0.5, [0.1, 1.0, 0.9])]) == [
        "Goal too fast: joint j1 would have to move at 2 rad/s to reach point 1 of 1 in time; "
        "its velocity limit is 1.5 rad/s"
    ]


def test_the_point_that_asks_for_most_is_named(violations):
    points = [(1.0, [0.0] * 3), (2.0, [1.6, 0.0, 0.0]), (2.1, [1.6, 0.0, -0.4])]
    (said,) = violations([*points, (9.0, [0.0] * 3)], "prismatic")
    assert "joint j2 would have to move at 4 m/s to reach point 3 of 4 in time" in said


def test_the_velocity_at_a_point_is_checked_as_well(violations):
    moving = [(5.0, [0.0] * 3, [0.0, 0.0, -1.6]), (9.0, [0.0] * 3, [0.0] * 3)]
    (said,) = violations(moving)
    assert "joint j2 would have to move at 1.6 rad/s" in said


def test_a_goal_that_the_joints_can_follow_is_not_spoken_of(violations):
    assert violations([(2.0, [1.0, 2.0, -1.0]), (4.0, [0.0] * 3)]) == []
    # The short way round, joints that are not named, points without positions.
    assert violations([(1.0, [6.0] * 3)], "continuous") == []
    partial = {"allow_partial_joints_goal": True, "allow_integration_in_goal_trajectories": True}
    assert violations([(1.0, [1.0])], joints=("j1",), **partial) == []
    assert violations([(1.0, [], [1.0] * 3), (2.0, [], [0.0] * 3)], **partial) == []


def test_a_point_that_is_due_at_once_is_not_judged(violations):
    assert violations([(0.0, [1.0] * 3)]) == []
