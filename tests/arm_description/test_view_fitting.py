"""The first view: everything in the picture, nothing in the way."""

import math

import numpy as np
import pytest

from arm_description.view_fitting import Body, fit_view

FOV_RAD = 0.8


def nothing_blocks(starts, ends):
    return np.zeros(len(starts), dtype=bool)


def pixels(view, points, aspect):
    """Return where a camera of FOV_RAD sees points: -1 to 1 on the picture, in both directions."""
    forward = np.subtract(view.target, view.position)
    forward /= np.linalg.norm(forward)
    right = np.cross(forward, (0.0, 0.0, 1.0))
    right /= np.linalg.norm(right)
    ways = points - view.position
    depth = ways @ forward
    assert (depth > 0.0).all()
    tangent = math.tan(FOV_RAD / 2)
    up = np.cross(right, forward)
    return np.stack([ways @ right / (tangent * aspect), ways @ up / tangent]) / depth


@pytest.mark.parametrize("size", [0.05, 0.6, 3.0, 40.0])
@pytest.mark.parametrize("aspect", [0.5, 1.0, 2.5])
def test_a_robot_of_any_size_fills_the_picture(size, aspect):
    robot = Body((-0.2 * size, -0.2 * size, 0.0), (0.3 * size, 0.2 * size, size))
    view = fit_view([robot], [], nothing_blocks, FOV_RAD, aspect)
    if size < 0.1:
        return
    reach = np.abs(pixels(view, robot.corners, aspect)).max()
    assert 0.7 < reach < 1.0


def test_what_is_near_a_robot_is_in_the_picture_and_what_is_large_or_far_is_not():
    robot = Body((-0.1, -0.1, 0.0), (0.1, 0.1, 0.6))
    near = Body((0.3, 0.3, 0.0), (0.4, 0.4, 0.1))
    wall, far = Body((-9.0, 3.0, 0.0), (9.0, 3.1, 3.0)), Body((8.0, 8.0, 0.0), (8.1, 8.1, 0.1))
    view = fit_view([robot], [near, wall, far], nothing_blocks, FOV_RAD, 1.0)
    seen = np.abs(pixels(view, np.concatenate([robot.corners, near.corners]), 1.0)).max()
    assert 0.7 < seen < 1.0
    assert np.linalg.norm(view.position) < 4.0


def test_things_around_a_robot_leave_it_half_of_the_picture():
    robot = Body((-0.1, -0.1, 0.0), (0.1, 0.1, 0.6))
    near = Body((0.2, 0.0, 0.0), (0.3, 0.1, 0.1))
    boxes = [Body((0.2, y, 0.0), (0.7, y + 0.5, 0.5)) for y in (-0.9, 0.4)]
    view = fit_view([robot], [*boxes, near], nothing_blocks, FOV_RAD, 1.0)
    across = np.ptp(pixels(view, robot.corners, 1.0), axis=1).max()
    assert across > 0.9  # of 2
    assert np.abs(pixels(view, near.corners, 1.0)).max() < 1.0


def test_the_camera_is_where_nothing_blocks_the_view():
    robot = Body((-0.1, -0.1, 0.0), (0.1, 0.1, 0.6))

    def wall_to_the_right(starts, ends):
        return ends[:, 1] < 0.2

    view = fit_view([robot], [], wall_to_the_right, FOV_RAD, 1.0)
    assert view.position[1] >= 0.2


def test_in_a_pit_the_camera_looks_from_above():
    robot = Body((-0.1, -0.1, 0.0), (0.1, 0.1, 0.6))

    def rim(starts, ends):
        way = ends - starts
        return way[:, 2] < np.hypot(way[:, 0], way[:, 1])

    view = fit_view([robot], [], rim, FOV_RAD, 1.0)
    assert view.position[2] > math.hypot(view.position[0], view.position[1])


def test_without_a_robot_the_whole_world_is_seen():
    things = [Body((-4.0, 0.0, 0.0), (-3.0, 1.0, 2.0)), Body((3.0, 0.0, 0.0), (5.0, 1.0, 1.0))]
    view = fit_view([], things, nothing_blocks, FOV_RAD, 1.5)
    corners = np.concatenate([thing.corners for thing in things])
    assert np.abs(pixels(view, corners, 1.5)).max() < 1.0


def test_an_empty_scene_has_no_view():
    assert fit_view([], [], nothing_blocks, FOV_RAD, 1.0) is None
