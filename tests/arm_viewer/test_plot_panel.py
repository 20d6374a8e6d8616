"""What the charts draw."""

import math

import numpy as np

from arm_viewer.panels.plot_panel import extent, unbroken


def test_what_was_not_said_lies_between_its_neighbours():
    ages = np.array([-4.0, -3.0, -1.0, 0.0])
    rows = np.array([[1.0, math.nan, math.nan, 5.0], [math.nan, 2.0, 3.0, math.nan]])
    np.testing.assert_allclose(unbroken(ages, rows), [[1.0, 2.0, 4.0, 5.0], [2.0, 2.0, 3.0, 3.0]])


def test_a_row_of_nothing_stays_one():
    assert np.isnan(unbroken(np.array([-1.0, 0.0]), np.full((1, 2), math.nan))).all()


def test_a_chart_of_joints_at_rest_is_not_all_noise():
    resting = np.array([[1.0, 1.0001, 0.9999, 1.0], [1.2, 1.2, 1.2, 1.2]])
    np.testing.assert_allclose(extent(resting, 0.5), [0.84995, 1.34995, 0.84995, 1.34995])


def test_a_chart_of_joints_that_move_is_as_high_as_they_go():
    np.testing.assert_allclose(extent(np.array([[-1.0, 2.0, 0.0]]), 0.5), [-1.0, 2.0, -1.0])
