"""The way of a point: what is sent, and what is left out."""

from unittest.mock import MagicMock

import numpy as np
import pytest

from arm_viewer.scene.trail import CHUNK, CHUNKS, PointTrail


class Scene:
    """Stands for the scene; keeps the lines that are in it."""

    def __init__(self):
        self.lines = {}

    def add_line_segments(self, path, points, colour, thickness):
        node = MagicMock(points=points)
        node.remove.side_effect = lambda: self.lines.pop(path)
        self.lines[path] = node
        return node

    @property
    def points(self):
        return np.concatenate([node.points.reshape(-1, 3) for node in self.lines.values()])


@pytest.fixture
def scene():
    return Scene()


def walk(trail, count, step_m=0.01):
    for index in range(count):
        trail.add((index * step_m, 0.0, 0.0))
        trail.draw()


def test_a_point_at_rest_draws_nothing(scene):
    trail = PointTrail(scene)
    for _ in range(10):
        trail.add((0.1, 0.2, 0.3))
        trail.draw()
    assert scene.lines == {}


def test_the_line_has_no_gap_between_its_nodes(scene):
    walk(PointTrail(scene), 3 * CHUNK)
    assert len(scene.lines) == 3
    starts, ends = scene.points[::2, 0], scene.points[1::2, 0]
    assert starts[1:] == pytest.approx(ends[:-1])
    assert ends[-1] == pytest.approx((3 * CHUNK - 1) * 0.01)


def test_a_jump_begins_a_new_line(scene):
    trail = PointTrail(scene)
    walk(trail, 3)
    trail.add((5.0, 0.0, 0.0))
    trail.add((5.1, 0.0, 0.0))
    trail.draw()
    assert scene.points[:, 0].tolist() == pytest.approx([0.0, 0.01, 0.01, 0.02, 5.0, 5.1])


def test_the_oldest_nodes_go_and_clearing_removes_all(scene):
    trail = PointTrail(scene)
    walk(trail, (CHUNKS + 3) * CHUNK)
    assert len(scene.lines) == CHUNKS
    trail.clear()
    assert scene.lines == {}
