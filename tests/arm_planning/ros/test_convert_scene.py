"""Scenes from and to messages."""

import pytest
from geometry_msgs.msg import Point, Pose
from moveit_msgs.msg import (
    AllowedCollisionEntry,
    AllowedCollisionMatrix,
    AttachedCollisionObject,
    CollisionObject,
    ObjectColor,
    PlanningSceneComponents,
)
from moveit_msgs.msg import PlanningScene as SceneMessage
from planar_robot import planar_model
from shape_msgs.msg import Mesh, MeshTriangle, Plane, SolidPrimitive

from arm_planning.errors import PlanningError
from arm_planning.ros.convert_scene import object_change_of, scene_change_of, scene_message
from arm_planning.scene.scene import PlanningScene
from arm_planning.scene.scene_changes import change_scene

MODEL = planar_model()
EMPTY = PlanningScene({"shoulder": 0.5, "elbow": 1.0})


def pose(x: float = 0.0, y: float = 0.0, z: float = 0.0) -> Pose:
    return Pose(position=Point(x=x, y=y, z=z))


def box(name: str, **fields: object) -> CollisionObject:
    message = CollisionObject(id=name, operation=CollisionObject.ADD, pose=pose(2.0), **fields)
    message.primitives = [
        SolidPrimitive(type=SolidPrimitive.BOX, dimensions=[0.1, 0.2, 0.3]),
        SolidPrimitive(type=SolidPrimitive.CYLINDER, dimensions=[0.4, 0.05]),
    ]
    message.primitive_poses = [pose(0.0, 0.1), pose(0.0, 0.0, 0.2)]
    return message


def mesh(name: str) -> CollisionObject:
    message = CollisionObject(id=name, operation=CollisionObject.ADD, pose=pose(3.0))
    corners = [Point(), Point(x=1.0), Point(y=1.0), Point(z=1.0)]
    faces = [[0, 2, 1], [0, 1, 3], [0, 3, 2], [1, 2, 3]]
    message.meshes = [
        Mesh(vertices=corners, triangles=[MeshTriangle(vertex_indices=face) for face in faces])
    ]
    message.mesh_poses = [pose(0.5)]
    message.planes = [Plane(coef=[0.0, 0.0, 1.0, 0.1])]
    message.plane_poses = [pose()]
    message.subframe_names, message.subframe_poses = ["corner"], [pose(1.0)]
    message.type.key, message.type.db = "tetrahedron", "shapes"
    return message


def whole_scene() -> SceneMessage:
    message = SceneMessage(name="kitchen", robot_model_name="planar")
    message.world.collision_objects = [box("table"), mesh("thing")]
    message.robot_state.joint_state.name = ["shoulder", "elbow"]
    message.robot_state.joint_state.position = [0.1, 0.2]
    held = AttachedCollisionObject(link_name="tip", object=box("can"), touch_links=["finger"])
    held.object.header.frame_id = "tip"
    message.robot_state.attached_collision_objects = [held]
    message.allowed_collision_matrix = AllowedCollisionMatrix(
        entry_names=["fore", "upper"],
        entry_values=[
            AllowedCollisionEntry(enabled=[False, True]),
            AllowedCollisionEntry(enabled=[True, False]),
        ],
        default_entry_names=["table"],
        default_entry_values=[True],
    )
    colour = ObjectColor(id="table")
    colour.color.r, colour.color.a = 0.5, 1.0
    message.object_colors = [colour]
    return message


def applied(message: SceneMessage, scene: PlanningScene = EMPTY) -> PlanningScene:
    outcome = change_scene(MODEL, scene, scene_change_of(MODEL, message, print))
    assert not outcome.problems
    return outcome.scene


def test_a_whole_scene_comes_back_as_it_was():
    once = applied(whole_scene())
    message = scene_message(MODEL, once)
    twice = applied(message)
    assert scene_message(MODEL, twice) == message
    assert {each.id for each in message.world.collision_objects} == {"table", "thing"}
    assert message.name == "kitchen"
    (held,) = message.robot_state.attached_collision_objects
    assert (held.link_name, held.object.id, list(held.touch_links)) == ("tip", "can", ["finger"])
    assert once.allowed.may_touch("upper", "fore")


def test_the_parts_of_an_object_come_back_as_they_were():
    message = scene_message(MODEL, applied(whole_scene()))
    table, thing = message.world.collision_objects
    assert [list(each.dimensions) for each in table.primitives] == [[0.1, 0.2, 0.3], [0.4, 0.05]]
    assert table.primitive_poses[0].position.y == 0.1
    assert thing.meshes == mesh("thing").meshes
    assert [list(plane.coef) for plane in thing.planes] == [[0.0, 0.0, 1.0, 0.1]]
    assert (thing.type.key, thing.type.db) == ("tetrahedron", "shapes")
    assert thing.subframe_names == ["corner"]


def test_only_the_parts_that_are_asked_for_are_sent():
    scene = applied(whole_scene())
    names = scene_message(MODEL, scene, PlanningSceneComponents.WORLD_OBJECT_NAMES)
    assert [each.id for each in names.world.collision_objects] == ["table", "thing"]
    assert not names.world.collision_objects[0].primitives
    assert not names.robot_state.joint_state.name
    state = scene_message(MODEL, scene, PlanningSceneComponents.ROBOT_STATE)
    assert list(state.robot_state.joint_state.name) == ["shoulder", "elbow", "grip"]
    assert not state.robot_state.attached_collision_objects


def test_an_empty_diff_changes_nothing():
    message = SceneMessage(is_diff=True)
    message.robot_state.is_diff = True
    scene = applied(whole_scene())
    assert applied(message, scene) == scene


@pytest.mark.parametrize(
    ("change", "problem"),
    [
        ({"operation": b"\x09"}, "object 'b' has the operation b'\\\\t'; there are ADD, REMOVE"),
        ({"subframe_names": ["lid"]}, "object 'b' has 1 names and 0 poses of subframes"),
    ],
)
def test_objects_that_mean_nothing_are_refused(change, problem):
    message = box("b")
    for name, value in change.items():
        setattr(message, name, value)
    with pytest.raises(PlanningError, match=problem):
        object_change_of(message)


def test_a_matrix_with_a_short_row_is_refused():
    message = SceneMessage(is_diff=True)
    message.allowed_collision_matrix.entry_names = ["fore", "upper"]
    message.allowed_collision_matrix.entry_values = [AllowedCollisionEntry(enabled=[True])]
    with pytest.raises(PlanningError, match=r"2 names \(fore, upper\) but its rows are not"):
        scene_change_of(MODEL, message, print)
