"""The layers of a link: materials, centre of mass, inertia."""

import numpy as np
import pytest
from viser import SceneApi

from arm_description.transforms import rotation_from_rpy
from arm_description.urdf.parser import parse_urdf
from arm_description.urdf.robot import Inertial, Pose
from arm_node.rigid_transform import rotated
from arm_viewer.scene.link_layers import draw_collisions, draw_visuals, inertia_ellipsoid

URDF = """<robot name="r"><link name="hand">
<visual><geometry><mesh filename="{mesh}"/></geometry></visual>
<collision><geometry><mesh filename="{mesh}"/></geometry></collision></link></robot>"""


class NoScene(SceneApi):
    """A scene in which nothing can be drawn."""

    def __init__(self) -> None:
        """Have nothing."""


@pytest.mark.parametrize("draw", [draw_visuals, draw_collisions])
def test_a_mesh_that_cannot_be_had_is_named_with_its_link(draw, tmp_path):
    broken = tmp_path / "broken.stl"
    broken.write_bytes(b"no mesh")
    problems: list[str] = []
    for mesh in ("package://nowhere/hand.stl", str(broken)):
        (link,) = parse_urdf(URDF.format(mesh=mesh)).links
        assert list(draw(NoScene(), "/hand", link, problems.append)) == []
    missing, unreadable = problems
    assert missing == "link 'hand': no file for 'package://nowhere/hand.stl'"
    assert unreadable.startswith(f"link 'hand': cannot use the mesh {broken}: ")


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
def test_an_impossible_inertia_has_no_ellipsoid(mass, moments):
    x, y, z = moments
    assert inertia_ellipsoid(Inertial(mass, Pose(), (x, 0, 0, y, 0, z))) is None
