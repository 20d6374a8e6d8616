"""Where a planned motion is on its way."""

import numpy as np
import pytest

from arm_planning.trajectory import TimedTrajectory
from arm_viewer.planned_path import planned_path


def motion(joint: str, times, values) -> TimedTrajectory:
    column = np.array(values, dtype=float).reshape(-1, 1)
    return TimedTrajectory((joint,), np.array(times, dtype=float), column, column, column)


@pytest.fixture
def path(model):
    motions = [motion("shoulder", [0, 2], [0, 1]), motion("elbow", [0, 1], [0, 0.5])]
    return planned_path(model, {"shoulder": 0.0, "elbow": 0.0}, motions)


@pytest.mark.parametrize(
    ("time_s", "shoulder", "elbow"),
    [(-1, 0, 0), (0, 0, 0), (1, 0.5, 0), (2, 1, 0), (2.5, 1, 0.25), (3, 1, 0.5), (9, 1, 0.5)],
)
def test_positions_are_linear_between_way_points_and_stay_at_both_ends(
    path, time_s, shoulder, elbow
):
    positions = path.positions_at(time_s)
    assert positions == {"shoulder": pytest.approx(shoulder), "elbow": pytest.approx(elbow)}


def test_motions_that_follow_one_another_add_up(path):
    assert (path.duration_s, path.points) == (3.0, 4)


def test_the_trail_is_that_of_the_tip_of_the_group_that_moves(path):
    assert path.tip() == "finger"
    trail = path.trail()
    assert trail[0] == pytest.approx([2.0, 0.0, 0.0])
    end = [np.cos(1.0) + np.cos(1.5), 0.0, -np.sin(1.0) - np.sin(1.5)]
    assert trail[-1] == pytest.approx(end)


def test_without_a_group_the_trail_is_that_of_the_last_moved_link(model):
    path = planned_path(model, {}, [motion("shoulder", [0, 1], [0, 1])])
    assert path is not None
    assert path.tip() == "upper"


def test_the_summary_has_time_way_points_and_length(path):
    said = path.summary(0.012)
    length_m = 2.0 + 0.5
    assert said.startswith("3.00 s, 4 points; finger moves ")
    assert float(said.split("moves ")[1].split(" m")[0]) == pytest.approx(length_m, abs=0.002)
    assert said.endswith("; planned in 12 ms")
    assert "planned" not in path.summary()


def test_a_motion_without_points_or_of_another_robot_is_no_path(model):
    assert planned_path(model, {}, []) is None
    assert planned_path(model, {}, [motion("shoulder", [], [])]) is None
    assert planned_path(model, {}, [motion("wheel", [0, 1], [0, 1])]) is None


def test_the_same_motion_is_recognised(model, path):
    again = [motion("shoulder", [0, 2], [0, 1]), motion("elbow", [0, 1], [0, 0.5])]
    other = [motion("shoulder", [0, 2], [0, 1]), motion("elbow", [0, 1], [0, 0.6])]
    assert path.is_same(planned_path(model, {}, again))
    assert not path.is_same(planned_path(model, {}, other))
    assert not path.is_same(planned_path(model, {}, again[:1]))
