"""Whole turns."""

import numpy as np
import pytest

from arm_control.joint_trajectory.angles import nearest_turn, shortest_way

PI = np.pi


@pytest.mark.parametrize(
    ("start", "end", "way"),
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
def test_shortest_way(start: float, end: float, way: float):
    assert shortest_way(np.array([start]), np.array([end])) == pytest.approx([way], abs=1e-9)


def test_nan_stays_nan():
    assert np.isnan(shortest_way(np.array([np.nan]), np.array([1.0])))


class TestNearestTurn:
    """TestWrapAroundJoint of upstream: the start moves, the way point stays."""

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
