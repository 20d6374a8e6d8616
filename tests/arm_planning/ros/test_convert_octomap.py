"""Octomaps as messages, as part of a scene, and those that cannot be used."""

from array import array

import numpy as np
import pytest
from moveit_msgs.msg import PlanningScene as SceneMessage
from moveit_msgs.msg import PlanningSceneComponents
from robots import collision, joint, link, robot

from arm_description.urdf.parser import parse_urdf
from arm_node.rigid_transform import RigidTransform
from arm_planning.collision.model import CollisionModel
from arm_planning.errors import PlanningError
from arm_planning.robot.build import planning_model
from arm_planning.robot.srdf import parse_srdf
from arm_planning.ros.convert_scene import (
    octomap_change_of,
    octomap_message,
    scene_change_of,
    scene_message,
)
from arm_planning.scene.allowed_collisions import AllowedCollisions
from arm_planning.scene.occupancy_map import OCTOMAP, OccupancyMap
from arm_planning.scene.octree import Cubes
from arm_planning.scene.scene import PlanningScene
from arm_planning.scene.scene_changes import change_scene

ROBOT = parse_urdf(
    robot(
        link("base"),
        link("ball", collision("sphere", radius="0.05")),
        joint("slide", "base", "ball", kind="prismatic", axis="1 0 0", limits=(0.0, 2.0)),
    )
)
MODEL = planning_model(ROBOT, parse_srdf("<robot name='r'/>", ROBOT))
SCENE = PlanningScene({"slide": 0.0})
CELLS = np.array([[10, 0, 0], [10, -1, 0], [11, 0, 0]])
MAP = OccupancyMap(0.1, Cubes(CELLS, np.ones(3, np.int64)), RigidTransform((0.2, 0.0, 0.0)))


def message_with(**changes):
    message = SceneMessage(is_diff=True)
    message.robot_state.is_diff = True
    message.world.octomap = octomap_message(MAP, MODEL.frame)
    for name, value in changes.items():
        holder = message.world.octomap
        setattr(holder if hasattr(holder, name) else holder.octomap, name, value)
    return message


def changed(message, scene=SCENE):
    outcome = change_scene(MODEL, scene, scene_change_of(MODEL, message, print))
    assert not outcome.problems
    return outcome.scene


def test_an_octomap_comes_through_a_scene_message_as_it_is():
    scene = changed(scene_message(MODEL, changed(message_with())))
    assert scene.octomap.resolution_m == MAP.resolution_m
    assert scene.octomap.pose.position == pytest.approx(MAP.pose.position)
    got, wanted = (np.unique(each.cubes.corners, axis=0) for each in (scene.octomap, MAP))
    np.testing.assert_array_equal(got, wanted)
    parts = scene_message(MODEL, scene, PlanningSceneComponents.WORLD_OBJECT_NAMES)
    assert parts.world.octomap.octomap.id == ""
    assert not parts.world.collision_objects


def test_the_robot_collides_with_it_and_may_be_allowed_to():
    scene = changed(message_with())
    checker = CollisionModel(MODEL, scene)
    assert checker.is_free(np.array([1.0]))
    (contact,) = checker.contacts(np.array([1.2]))
    assert {contact.first, contact.second} == {"ball", OCTOMAP}
    allowed = AllowedCollisions({(OCTOMAP, "ball"): True})
    after = CollisionModel(MODEL, PlanningScene(SCENE.positions, octomap=MAP, allowed=allowed))
    assert after.is_free(np.array([1.2]))


def test_a_model_of_a_scene_before_is_taken_over():
    before = CollisionModel(MODEL, SCENE)
    with_map = CollisionModel(MODEL, changed(message_with()), like=before)
    assert not with_map.is_free(np.array([1.2]))
    assert CollisionModel(MODEL, SCENE, like=with_map).is_free(np.array([1.2]))


def test_without_an_id_it_stays_and_without_data_it_goes():
    scene = changed(message_with())
    assert changed(message_with(id="", data=array("b")), scene).octomap is scene.octomap
    assert changed(message_with(id="cleared", data=array("b")), scene).octomap is None
    full = message_with(id="", data=array("b"))
    full.is_diff = False
    assert changed(full, scene).octomap is None


@pytest.mark.parametrize(
    ("changes", "says"),
    [
        ({"id": "ColorOcTree"}, "of the kind 'ColorOcTree', and 'OcTree' is read"),
        ({"data": array("b", [0, 12, 3])}, "end in the middle of the tree"),
        ({"binary": False}, "octomap cannot be used"),
    ],
)
def test_data_that_are_not_an_octree_are_told_why(changes, says):
    with pytest.raises(PlanningError, match=says):
        octomap_change_of(message_with(**changes).world.octomap)


@pytest.mark.parametrize("resolution", [0.0, -1.0, float("nan"), float("inf")])
def test_one_without_a_resolution_leaves_the_scene_as_it_is(resolution):
    message = message_with(resolution=resolution)
    outcome = change_scene(MODEL, SCENE, scene_change_of(MODEL, message, print))
    assert "its resolution is" in str(outcome.problems[0])
    assert outcome.scene.octomap is None


def test_one_in_an_unknown_frame_is_told_so():
    message = message_with()
    message.world.octomap.header.frame_id = "moon"
    outcome = change_scene(MODEL, SCENE, scene_change_of(MODEL, message, print))
    assert "moon" in str(outcome.problems[0])
