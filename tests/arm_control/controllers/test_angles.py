"""Shortest rotations and whole turns of continuous joints."""

import numpy as np
import pytest

from arm_control.controllers.angles import nearest_turn, shortest_angular_distance

PI = np.pi


@pytest.mark.parametrize(
    ("start", "end", "distance"),
    [
        (0.0, 1.0, 1.0),
        (0.0, 1.5 * PI, -0.5 * PI),
        (0.0, -1.5 * PI, 0.5 * PI),
        (0.1, 0.1 + 6.0 * PI, 0.0),
        (0.0, PI, PI),
        (PI, 0.0, -PI),
        (0.0, 3.0 * PI, PI),
        (0.0, -PI, -PI),
    ],
)
def test_shortest_angular_distance(start, end, distance):
    assert shortest_angular_distance(np.array([start]), np.array([end])) == pytest.approx(
        [distance], abs=1e-9
    )


def test_nan_stays_nan():
    assert np.isnan(shortest_angular_distance(np.array([np.nan]), np.array([1.0])))


class TestNearestTurn:
    """TestWrapAroundJoint of upstream: the start moves, the waypoint stays."""

    start = np.zeros(3)
    end = np.full(3, 1.5 * PI)

    def moved(self, *continuous: bool, start: np.ndarray | None = None) -> np.ndarray:
        start = self.start if start is None else start
        return nearest_turn(start, self.end, np.array(continuous))

    def test_no_wraparound(self):
        assert self.moved(False, False, False).tolist() == [0.0, 0.0, 0.0]

    def test_wraparound_single_joint(self):
        assert self.moved(True, False, False) == pytest.approx([2.0 * PI, 0.0, 0.0])

    def test_wraparound_all_joints(self):
        assert self.moved(True, True, True) == pytest.approx([2.0 * PI] * 3)

    def test_wraparound_all_joints_no_offset(self):
        assert self.moved(True, True, True, start=self.end) == pytest.approx(self.end)
