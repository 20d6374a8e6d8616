"""Objects of the planning scene in the 3D view."""

from types import SimpleNamespace

import numpy as np
import pytest

from arm_description.urdf.robot import Box
from arm_node.rigid_transform import RigidTransform
from arm_planning.scene.frames import LinkPoses
from arm_planning.scene.objects import AttachedBody, CollisionObject, PlacedShape
from arm_planning.scene.scene import PlanningScene
from arm_planning.scene.shapes import Cone, Plane, TriangleMesh
from arm_viewer.scene.planning_objects import ATTACHED_COLOUR, WORLD_COLOUR, PlanningObjects

ORIGIN = RigidTransform((0.0, 0.0, 1.0))
BOX = CollisionObject("box", RigidTransform((0.5, 0.0, 0.0)), (PlacedShape(Box((1, 1, 1))),))


class RecordingScene:
    """A scene that keeps what is drawn, by path."""

    def __init__(self):
        self.nodes = {}

    def add_frame(self, path, **look):
        return self._add(path, look)

    def add_mesh_simple(self, path, vertices, faces, **look):
        return self._add(path, {"vertices": vertices, **look})

    def _add(self, path, look):
        node = self.nodes[path] = SimpleNamespace(**look)
        node.remove = lambda: [self.nodes.pop(each) for each in list(self.nodes) if path in each]
        return node


@pytest.fixture
def drawn(model):
    """Draw a planning scene with the arm along x; return the nodes by their names."""
    scene = RecordingScene()
    objects = PlanningObjects(scene, "objects")

    def draw(wanted):
        objects.update(wanted, ORIGIN, LinkPoses(model, {}))
        return scene.nodes

    return draw


def test_an_object_stands_where_planning_has_it_and_one_on_the_robot_moves_along(drawn):
    held = AttachedBody(CollisionObject("cup", RigidTransform(), BOX.shapes), "hand")
    nodes = drawn(PlanningScene({}, {"box": BOX}, {"cup": held}))
    assert tuple(nodes["/planning/objects/box"].position) == (0.5, 0.0, 1.0)
    assert tuple(nodes["/planning/objects/cup"].position) == (1.0, 0.0, 1.0)
    assert nodes["/planning/objects/box/shape_0_0"].color == WORLD_COLOUR
    assert nodes["/planning/objects/cup/shape_0_0"].color == ATTACHED_COLOUR


def test_a_moved_object_is_not_drawn_again_and_a_removed_one_goes(drawn):
    before = drawn(PlanningScene({}, {"box": BOX}))["/planning/objects/box"]
    moved = CollisionObject("box", RigidTransform((0.7, 0.0, 0.0)), BOX.shapes)
    after = drawn(PlanningScene({}, {"box": moved}))["/planning/objects/box"]
    assert after is before
    assert tuple(after.position) == (0.7, 0.0, 1.0)
    assert drawn(PlanningScene({})) == {}


@pytest.mark.parametrize(
    ("shape", "low", "high"),
    [
        (Cone(0.5, 2.0), (-0.5, -0.5, -1.0), (0.5, 0.5, 1.0)),
        (Plane(0.0, 0.0, 2.0, -1.0), (-1.0, -1.0, 0.5), (1.0, 1.0, 0.5)),
        (
            TriangleMesh(np.array([[0, 0, 0], [2, 0, 0], [0, 3, 0.0]]), np.array([[0, 1, 2]])),
            (0.0, 0.0, 0.0),
            (2.0, 3.0, 0.0),
        ),
    ],
)
def test_shapes_that_no_urdf_has_are_drawn_where_they_are(drawn, shape, low, high):
    each = CollisionObject("it", RigidTransform(), (PlacedShape(shape),))
    vertices = drawn(PlanningScene({}, {"it": each}))["/planning/objects/it/shape_0_0"].vertices
    assert vertices.min(axis=0) == pytest.approx(low, abs=1e-6)
    assert vertices.max(axis=0) == pytest.approx(high, abs=1e-6)
