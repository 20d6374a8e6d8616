"""The reach of a link: where it is, and how it is drawn."""

import math
from unittest.mock import MagicMock

import numpy as np
import pytest
from robots import joint, link, robot

from arm_description.kinematics.forward import forward_kinematics
from arm_description.urdf.parser import parse_urdf
from arm_viewer.scene.reach import CELLS, ReachCloud, cells_of, reachable_points

TURNED = parse_urdf(
    robot(
        *map(link, ("base", "upper", "hand", "tool")),
        joint("turn", "base", "upper", xyz="0 0 0.1", axis="0 0 1", limits=(0.0, 1.5)),
        joint(
            *("slide", "upper", "hand"),
            kind="prismatic",
            xyz="0.5 0 0",
            axis="1 0 0",
            limits=(0.0, 1.5),
        ),
        "<joint name='mount' type='fixed'><parent link='hand'/><child link='tool'/>"
        "<origin xyz='0 0.2 0' rpy='0 0 1'/></joint>",
    ),
    "test",
)


def test_points_are_those_of_forward_kinematics():
    points = reachable_points(TURNED, "tool", samples=500)
    assert points.shape == (500, 3)
    assert np.allclose(points[:, 2], 0.1)
    lengths = np.linalg.norm(points[:, :2], axis=1)
    ends = [
        np.linalg.norm(forward_kinematics(TURNED, {"turn": 0.0, "slide": at})["tool"][:2, 3])
        for at in (0.0, 1.5)
    ]
    assert ends[0] <= lengths.min() < ends[0] + 0.05
    assert ends[1] - 0.05 < lengths.max() <= ends[1]
    headings = np.arctan2(points[:, 1], points[:, 0])
    assert 0.0 < headings.min() < headings.max() < 1.5 + math.atan2(0.2, 0.5)
    assert np.array_equal(points, reachable_points(TURNED, "tool", samples=500))


def test_a_link_that_nothing_moves_is_at_one_place():
    points, counts, _ = cells_of(reachable_points(TURNED, "base"))
    assert (points.tolist(), counts.tolist()) == ([[0.0, 0.0, 0.0]], [1])


def test_each_cell_has_one_point_and_the_number_of_its_places():
    points = reachable_points(TURNED, "hand", samples=2000)
    means, counts, side_m = cells_of(points)
    assert side_m == pytest.approx(np.ptp(points, axis=0).max() / CELLS)
    assert counts.sum() == 2000
    assert len(means) == len(np.unique(np.floor(means / side_m), axis=0)) < 2000


def test_it_is_drawn_once_and_removed():
    scene = MagicMock()
    cloud = ReachCloud(scene)
    cloud.show(TURNED, "tool", "/base")
    path, points, colours = scene.add_point_cloud.call_args.args
    assert path == "/base/reach"
    assert points.shape == colours.shape
    cloud.hide()
    scene.add_point_cloud.return_value.remove.assert_called_once_with()
