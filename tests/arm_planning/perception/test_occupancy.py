"""What a depth camera's views teach about occupied space."""

from math import radians

import numpy as np
import pytest

from arm_planning.perception.occupancy import OccupancyGrid
from arm_planning.perception.testing import TableThing, camera_at, look, noisy

CAMERA = camera_at(radians(45))
BOX = TableThing("box", (0.0, 0.0), 0.0, (0.06, 0.06, 0.1))
RESOLUTION_M = 0.02


def view(*things, noise=0.0):
    return noisy(look(CAMERA, things).points, np.random.default_rng(0), noise)


def see(grid, points, obstacles=None):
    with np.errstate(invalid="ignore"):
        near = np.linalg.norm(points, axis=2) < 1.2
    grid.see(points, CAMERA.pose, near if obstacles is None else near & obstacles)


def above_the_table(grid):
    return grid.centres()[grid.centres()[:, 2] > RESOLUTION_M]


@pytest.fixture
def grid():
    return OccupancyGrid(RESOLUTION_M)


def test_the_faces_that_are_seen_are_occupied(grid):
    see(grid, view(BOX))
    found = above_the_table(grid)
    half = RESOLUTION_M / 2 + 1e-6
    assert (np.abs(found[:, :2]) <= 0.03 + half).all()
    assert found[:, 2].max() == pytest.approx(0.1, abs=half)
    # The camera is on the side of negative x; the table is seen all around.
    assert found[:, 0].min() < -0.02
    assert len(grid.centres()) > 10 * len(found)


def test_what_is_taken_away_is_cleared_by_looking_through_it(grid):
    for _ in range(3):
        see(grid, view(BOX))
    before = len(above_the_table(grid))
    see(grid, view())
    assert len(above_the_table(grid)) == before
    for _ in range(12):
        see(grid, view())
    assert len(above_the_table(grid)) == 0
    assert len(grid.centres()) > 100


def test_what_is_hidden_behind_something_stays(grid):
    behind = TableThing("box", (0.15, 0.0), 0.0, (0.04, 0.04, 0.03))
    front = TableThing("box", (0.0, 0.0), 0.0, (0.04, 0.2, 0.2))
    see(grid, view(behind))
    known = len(above_the_table(grid))
    assert known
    for _ in range(12):
        # Its points are not learned, as those of a robot are not.
        see(grid, view(front), np.zeros((CAMERA.height, CAMERA.width), bool))
    assert len(above_the_table(grid)) == known


def test_a_view_that_stays_the_same_changes_nothing(grid):
    for _ in range(5):
        see(grid, view(BOX, noise=0.002))
    before = grid.cubes().corners
    for _ in range(5):
        see(grid, view(BOX, noise=0.002))
    np.testing.assert_array_equal(grid.cubes().corners, before)


def test_a_view_without_any_point_teaches_nothing(grid):
    see(grid, view(BOX))
    before = grid.cubes().corners
    see(grid, np.full((48, 64, 3), np.nan, np.float32))
    np.testing.assert_array_equal(grid.cubes().corners, before)


def test_cubes_can_be_taken_away_and_all_forgotten(grid):
    see(grid, view(BOX))
    low = grid.centres()[:, 2] < RESOLUTION_M
    grid.remove(low)
    assert len(grid.centres()) == (~low).sum() > 0
    grid.clear()
    assert len(grid.cubes().edges) == 0
