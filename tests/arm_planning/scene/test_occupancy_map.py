"""An octomap as boxes of the scene."""

import numpy as np
import pytest

from arm_node.rigid_transform import RigidTransform
from arm_planning.errors import PlanningError
from arm_planning.scene import occupancy_map
from arm_planning.scene.occupancy_map import OccupancyMap, joined
from arm_planning.scene.octree import Cubes


def unit_cubes(cells):
    cells = np.asarray(cells, np.int64).reshape(-1, 3)
    return Cubes(cells, np.ones(len(cells), np.int64))


def filled(low, high):
    """Return all cells of boxes, and fail if two boxes share one."""
    cells = [
        tuple(corner + inside)
        for corner, size in zip(low, high - low, strict=True)
        for inside in np.indices(tuple(size)).reshape(3, -1).T
    ]
    assert len(cells) == len(set(cells))
    return set(cells)


def test_a_table_is_one_box():
    table = np.indices((40, 30, 1)).reshape(3, -1).T - 15
    low, high = joined(unit_cubes(table))
    assert low.tolist() == [[-15, -15, -15]]
    assert high.tolist() == [[25, 15, -14]]


def test_boxes_fill_the_same_cells_and_overlap_nowhere():
    random = np.random.default_rng(0)
    cells = np.unique(random.integers(-4, 5, (300, 3)), axis=0)
    low, high = joined(unit_cubes(cells))
    assert len(low) < 0.8 * len(cells)
    assert filled(low, high) == set(map(tuple, cells))


def test_large_cubes_are_joined_with_small_ones():
    cubes = Cubes(
        np.array([[0, 0, 0], [4, 0, 0], [4, 0, 1], [4, 1, 0], [4, 1, 1]]), np.array([4, 1, 1, 1, 1])
    )
    low, high = joined(cubes)
    assert len(low) == 3
    assert len(filled(low, high)) == 68


def test_a_cube_too_large_to_be_cut_stays_whole():
    low, high = joined(Cubes(np.array([[0, 0, 0]]), np.array([1 << 15])))
    assert (high - low).tolist() == [[1 << 15] * 3]


def test_boxes_are_in_metres_and_where_the_map_is():
    map_ = OccupancyMap(0.1, unit_cubes([(2, 0, 0), (3, 0, 0)]), RigidTransform((1.0, 0.0, 0.0)))
    (placed,) = map_.obstacle.shapes
    assert placed.shape.size == pytest.approx((0.2, 0.1, 0.1))
    assert placed.pose.position == pytest.approx((0.3, 0.05, 0.05))
    assert map_.obstacle.pose.position == (1.0, 0.0, 0.0)
    assert not OccupancyMap(0.1, unit_cubes([])).obstacle.shapes


@pytest.mark.parametrize("resolution_m", [0.0, -0.1, float("nan"), float("inf")])
def test_a_resolution_that_is_no_size_is_refused(resolution_m):
    with pytest.raises(PlanningError, match=r"its resolution is .* it is finite and above 0"):
        OccupancyMap(resolution_m, unit_cubes([(0, 0, 0)]))


def test_more_boxes_than_can_be_checked_are_refused(monkeypatch):
    monkeypatch.setattr(occupancy_map, "MOST_BOXES", 2)
    with pytest.raises(PlanningError, match="it makes 3 boxes, and at most 2"):
        OccupancyMap(0.1, unit_cubes([(0, 0, 0), (2, 0, 0), (4, 0, 0)]))
