import itertools

import numpy as np
import pytest

from arm_planning.timing.rounded_path import rounded_paths


def states(path, piece, count=50):
    along = np.linspace(0.0, path.lengths[piece], count)
    pieces = np.full(count, piece)
    return path.positions(pieces, along), path.tangents(pieces, along)


def test_pieces_join_without_a_kink():
    points = np.random.default_rng(2).uniform(-1.0, 1.0, (7, 4))
    (path,) = rounded_paths(points, np.full(7, 0.1))
    ends = [states(path, piece) for piece in range(len(path.lengths))]
    for (before, heading), (after, next_heading) in itertools.pairwise(ends):
        assert before[-1] == pytest.approx(after[0], abs=1e-9)
        assert heading[-1] == pytest.approx(next_heading[0], abs=1e-9)
    assert ends[0][0][0] == pytest.approx(points[0])
    assert ends[-1][0][-1] == pytest.approx(points[-1], abs=1e-9)


@pytest.mark.parametrize("tolerance", [0.01, 0.1])
def test_an_arc_passes_its_corner_at_the_tolerance(tolerance):
    points = np.array([[0.0, 0.0], [2.0, 0.0], [2.0, 2.0]])
    (path,) = rounded_paths(points, np.full(3, tolerance))
    (arc,) = np.flatnonzero(path.curvatures)
    reached = np.linalg.norm(states(path, arc, 1001)[0] - points[1], axis=1).min()
    assert reached == pytest.approx(tolerance, rel=1e-4)


def test_an_arc_takes_at_most_half_of_a_side():
    points = np.array([[0.0, 0.0], [0.1, 0.0], [0.1, 5.0]])
    (path,) = rounded_paths(points, np.full(3, 9.0))
    assert path.lengths[0] == pytest.approx(0.05)


def test_derivatives_agree_with_differences():
    points = np.array([[0.0, 0.0, 0.0], [1.0, 0.0, 0.2], [1.0, 1.0, 0.0]])
    (path,) = rounded_paths(points, np.full(3, 0.1))
    arc = np.array([1])
    along, step = np.array([0.4 * path.lengths[1]]), 1e-5
    tangent = path.positions(arc, along + step) - path.positions(arc, along - step)
    assert path.tangents(arc, along) == pytest.approx(tangent / (2 * step), abs=1e-6)
    bend = path.tangents(arc, along + step) - path.tangents(arc, along - step)
    assert path.bends(arc, along) == pytest.approx(bend / (2 * step), abs=1e-4)


def test_it_is_split_where_it_stops():
    points = np.array([[0.0, 0.0], [1.0, 0.0], [1.0, 1.0], [1.0, 0.0]])
    stopping = rounded_paths(points, np.array([0.1, 0.0, 0.1, 0.1]))
    assert [path.starts[0].tolist() for path in stopping] == points[:3].tolist()
