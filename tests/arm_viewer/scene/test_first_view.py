"""When cameras of browsers are moved, and what blocks their view."""

from contextlib import nullcontext
from types import SimpleNamespace

import numpy as np
import pytest

from arm_description.view_fitting import Body, View
from arm_viewer.scene.first_view import Contents, FirstView, Obstacles

NOTHING = Obstacles(np.empty((0, 3, 3)), np.empty((0, 3)), np.empty((0, 3)), [])
ROBOT = Body((-0.5, -0.5, 0.0), (0.5, 0.5, 0.5))
LARGER = Body((-2.0, -2.0, 0.0), (2.0, 2.0, 2.0))


def contents(robot):
    return Contents([robot], [], NOTHING)


@pytest.fixture
def camera():
    return SimpleNamespace(position=np.zeros(3), look_at=np.zeros(3), aspect=1.2)


@pytest.fixture
def view(camera):
    client = SimpleNamespace(camera=camera, atomic=nullcontext)
    server = SimpleNamespace(
        get_clients=lambda: {7: client},
        initial_camera=SimpleNamespace(position=np.zeros(3), look_at=None),
    )
    shown = FirstView(server)
    shown.set_contents(contents(ROBOT))
    shown.update()
    return shown


def away(camera):
    return float(np.linalg.norm(np.subtract(camera.position, camera.look_at)))


def test_a_picture_that_becomes_narrower_is_fitted_again(view, camera):
    before = away(camera)
    camera.position = np.array(camera.position)
    camera.aspect = 0.6
    view.update()
    assert away(camera) > 1.5 * before


def test_contents_that_arrive_later_are_fitted_too(view, camera):
    before = away(camera)
    camera.position = np.array(camera.position)
    view.set_contents(contents(LARGER))
    view.update()
    assert away(camera) > 2.0 * before


def test_a_report_that_crosses_a_move_does_not_count_as_the_users_move(view, camera):
    put = camera.position
    camera.position, camera.aspect = np.zeros(3), 0.6
    view.update()
    assert np.linalg.norm(camera.position) > np.linalg.norm(put)


def test_a_camera_that_its_user_has_moved_stays_until_it_is_asked_for(view, camera):
    camera.position = moved = np.array([9.0, 9.0, 9.0])
    camera.aspect = 0.6
    view.set_contents(contents(LARGER))
    view.update()
    assert camera.position is moved
    view.fit_again(7)
    view.update()
    assert camera.position is not moved


def test_a_scene_is_due_once_it_has_settled(view):
    assert not view.is_due("robot", 10.0)
    assert not view.is_due("robot and world", 10.9)
    assert not view.is_due("robot and world", 11.5)
    assert view.is_due("robot and world", 12.0)


EYE = np.eye(3)[None]
QUARTER = np.array([[[0.0, -1.0, 0.0], [1.0, 0.0, 0.0], [0.0, 0.0, 1.0]]])
STARTS = np.array([[-2.0, 0.0, 0.0], [-2.0, 2.0, 0.0], [-2.0, 0.0, 0.0]])
ENDS = np.array([[2.0, 0.0, 0.0], [2.0, 2.0, 0.0], [-1.5, 0.0, 0.0]])


def test_a_box_blocks_lines_through_it():
    box = Obstacles(EYE, np.zeros((1, 3)), np.array([[0.5, 0.5, 0.5]]), [np.empty((0, 3, 3))])
    assert box.block(STARTS, ENDS).tolist() == [True, False, False]
    inside = np.zeros((1, 3))
    assert box.block(inside, ENDS[:1]).tolist() == [True]


def test_a_box_may_be_turned():
    halves = np.array([[3.0, 0.1, 0.1]])
    turned = Obstacles(QUARTER, np.zeros((1, 3)), halves, [np.empty((0, 3, 3))])
    assert turned.block(STARTS, ENDS).tolist() == [True, True, False]


def test_of_a_mesh_only_the_triangles_bar():
    # A frame of a window: one triangle above the line of sight, in a box around both.
    triangles = np.array([[[0.0, -1.0, 0.5], [0.0, 1.0, 0.5], [0.0, 0.0, 1.0]]])
    halves = np.array([[0.1, 1.0, 1.0]])
    frame = Obstacles(EYE, np.zeros((1, 3)), halves, [triangles])
    rays = np.array([[-2.0, 0.0, 0.0], [-2.0, 0.0, 0.7]])
    assert frame.block(rays, np.add(rays, (4.0, 0.0, 0.0))).tolist() == [False, True]


def test_nothing_bars_nothing():
    empty = Obstacles(np.empty((0, 3, 3)), np.empty((0, 3)), np.empty((0, 3)), [])
    assert not empty.block(STARTS, ENDS).any()


@pytest.fixture
def linked(camera):
    """A browser whose address names a view, before the page has anything to show."""
    camera.position = np.array([4.0, 3.0, 2.0])
    client = SimpleNamespace(camera=camera, atomic=nullcontext)
    initial = SimpleNamespace(position=np.ones(3), look_at=None)
    shown = FirstView(SimpleNamespace(get_clients=lambda: {7: client}, initial_camera=initial))
    shown.set_contents(contents(ROBOT))
    shown.update()
    return shown


def test_a_view_that_the_address_names_stays_until_another_is_asked_for(linked, camera):
    assert camera.position.tolist() == [4.0, 3.0, 2.0]
    linked.set_contents(contents(LARGER))
    linked.update()
    assert camera.position.tolist() == [4.0, 3.0, 2.0]
    linked.fit_again(7)
    linked.update()
    assert tuple(camera.position) != (4.0, 3.0, 2.0)


def test_a_chosen_view_moves_a_browser_with_a_view_of_its_own(linked, camera):
    linked.choose(View((1.0, 2.0, 3.0), (0.0, 0.0, 0.0)), [7])
    linked.update()
    assert tuple(camera.position) == (1.0, 2.0, 3.0)


def test_a_browser_that_came_before_the_scene_is_moved(camera):
    camera.position = np.ones(3)
    client = SimpleNamespace(camera=camera, atomic=nullcontext)
    initial = SimpleNamespace(position=np.ones(3), look_at=None)
    shown = FirstView(SimpleNamespace(get_clients=lambda: {7: client}, initial_camera=initial))
    shown.set_contents(contents(ROBOT))
    shown.update()
    assert tuple(camera.position) != (1.0, 1.0, 1.0)
