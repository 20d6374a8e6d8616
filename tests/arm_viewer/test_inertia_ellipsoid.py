"""The ellipsoid that has a link's mass and inertia."""

import numpy as np
import pytest

from arm_description.robot import Inertial, Pose
from arm_description.transforms import rotation_from_rpy
from arm_viewer.scene.frame_poses import rotated
from arm_viewer.scene.inertia_ellipsoid import inertia_ellipsoid

AXES = np.array([0.1, 0.2, 0.4])
MASS = 3.0


def inertia(axes, rotation=None):
    squares = np.square(axes)
    matrix = np.diag(MASS / 5.0 * (squares.sum() - squares))
    if rotation is not None:
        matrix = rotation @ matrix @ rotation.T
    return Inertial(MASS, Pose(), tuple(matrix[np.triu_indices(3)].tolist()))


@pytest.mark.parametrize(
    "rpy", [(0, 0, 0), (0.4, 0, 0), (0, 3.0, 0.2), (1.5, -1.0, 2.9), (np.pi, 0, 0)]
)
def test_it_is_the_ellipsoid_that_the_inertia_was_made_of(rpy):
    rotation = rotation_from_rpy(rpy)
    found = inertia_ellipsoid(inertia(AXES, rotation))
    assert found is not None
    axes, quaternion = found
    assert sorted(axes) == pytest.approx(sorted(AXES))
    for k, axis in enumerate(np.eye(3)):
        direction = np.array(rotated(quaternion, tuple(axis)))
        true = rotation[:, int(np.argmin(abs(AXES - axes[k])))]
        assert abs(direction @ true) == pytest.approx(1.0)


def test_a_thin_rod_has_no_thickness_but_an_ellipsoid():
    found = inertia_ellipsoid(inertia([0.0, 0.0, 0.5]))
    assert found is not None
    assert sorted(found[0]) == pytest.approx([0.0, 0.0, 0.5], abs=1e-6)


@pytest.mark.parametrize(
    ("mass", "moments"),
    [(0.0, (1, 1, 1)), (1.0, (1, 1, 5)), (1.0, (0, 0, 0)), (1.0, (1, 1, np.nan))],
)
def test_what_no_body_has_is_none(mass, moments):
    x, y, z = moments
    assert inertia_ellipsoid(Inertial(mass, Pose(), (x, 0, 0, y, 0, z))) is None
