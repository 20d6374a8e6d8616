"""What the charts draw."""

import math

import numpy as np

from arm_viewer.panels.plot_panel import unbroken


def test_what_was_not_said_lies_between_its_neighbours():
    ages = np.array([-4.0, -3.0, -1.0, 0.0])
    rows = np.array([[1.0, math.nan, math.nan, 5.0], [math.nan, 2.0, 3.0, math.nan]])
    np.testing.assert_allclose(unbroken(ages, rows), [[1.0, 2.0, 4.0, 5.0], [2.0, 2.0, 3.0, 3.0]])


def test_a_row_of_nothing_stays_one():
    assert np.isnan(unbroken(np.array([-1.0, 0.0]), np.full((1, 2), math.nan))).all()
