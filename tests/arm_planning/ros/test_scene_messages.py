import pytest
from planning_scenes import CUBE, at

from arm_description.urdf.robot import Box, Cylinder, Sphere
from arm_node.rigid_transform import RigidTransform
from arm_planning.ros.convert_scene import object_message
from arm_planning.scene.objects import CollisionObject, PlacedShape
from arm_planning.scene.shapes import Cone, Plane

SHIFTED = PlacedShape(CUBE.shape, at(z=1))


@pytest.mark.parametrize(
    ("pose", "shapes", "w"),
    [
        # Without a pose, the only shape's would count as the object's.
        (RigidTransform(), (SHIFTED,), -1.0),
        (RigidTransform(), (SHIFTED, CUBE), 1.0),
        (at(1), (SHIFTED,), 1.0),
    ],
)
def test_an_objects_pose_stays_its_own(pose, shapes, w):
    message = object_message(CollisionObject("box", pose, shapes), "world")
    assert message.pose.orientation.w == w
    assert message.pose.position.x == pose.position[0]
    assert message.primitive_poses[0].position.z == 1.0


def test_whole_numbers_are_taken():
    shapes = [Box((1, 2, 3)), Sphere(4), Cylinder(5, 6), Cone(7, 8), Plane(0, 0, 1, 9)]
    each = CollisionObject("box", at(1, 2, 3), tuple(map(PlacedShape, shapes)))
    message = object_message(each, "world")
    assert [list(primitive.dimensions) for primitive in message.primitives] == [
        [1.0, 2.0, 3.0],
        [4.0],
        [6.0, 5.0],
        [8.0, 7.0],
    ]
    assert list(message.planes[0].coef) == [0.0, 0.0, 1.0, 9.0]
