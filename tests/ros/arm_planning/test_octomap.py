"""`arm launch mycobot ... octomap:=true`: what the camera sees is in the way of the robot."""

import numpy as np
import pytest
from moveit_msgs.msg import CollisionObject
from moveit_msgs.srv import GetStateValidity
from shape_msgs.msg import SolidPrimitive
from std_srvs.srv import Empty

from arm_planning.scene.octree import decoded

PLACE, RADIUS_M, HEIGHT_M = (0.22, 0.12), 0.0125, 0.35
"""Of the red cylinder."""
FLOOR_M = -0.025
"""The planning frame is that of the robot's base."""


@pytest.fixture(scope="module")
def launched(launch_for_file):
    program = launch_for_file("mycobot", "use_camera:=true", "planning:=true", "octomap:=true")
    program.wait_until_ready()
    return program


def centres(planning):
    """Return the middles of the occupied cubes, and their edge."""
    octomap = planning.scene().world.octomap
    if not octomap.octomap.id:
        return np.empty((0, 3)), 0.0
    assert octomap.header.frame_id == "world"
    cubes = decoded(bytes(octomap.octomap.data), binary=octomap.octomap.binary)
    middles = octomap.octomap.resolution * (cubes.corners + 0.5 * cubes.edges[:, None])
    position = octomap.origin.position
    origin = np.array([position.x, position.y, position.z])
    return middles + origin, octomap.octomap.resolution


def of_cylinder(planning):
    """Return the cubes above the floor that are at the cylinder."""
    middles, edge = centres(planning)
    away = np.hypot(middles[:, 0] - PLACE[0], middles[:, 1] - PLACE[1])
    return middles[(away < RADIUS_M + edge) & (middles[:, 2] > 0.05)]


def eventually(planning, is_so, what):
    planning.client.wait_until(is_so, what)


def test_the_cylinder_and_the_floor_are_in_the_map_and_the_robot_is_not(planning):
    eventually(planning, lambda: len(of_cylinder(planning)) > 10, "the cylinder is in the map")
    middles, edge = centres(planning)
    assert edge == pytest.approx(0.02)
    assert of_cylinder(planning)[:, 2].max() == pytest.approx(FLOOR_M + HEIGHT_M, abs=0.015)
    assert (np.abs(middles[:, 2] - FLOOR_M) < 0.015).sum() > 200
    on_robot = np.hypot(middles[:, 0], middles[:, 1]) < 0.05
    assert not (on_robot & (middles[:, 2] > 0.1)).any()


def test_the_robot_must_not_touch_it(planning, request_of, joint_goal, joints):
    eventually(planning, lambda: len(of_cylinder(planning)) > 10, "the cylinder is in the map")
    request = GetStateValidity.Request(group_name="arm")
    request.robot_state.is_diff = True
    state = request.robot_state.joint_state
    reaching = joints(-0.8, -1.0)
    state.name, state.position = list(reaching), list(reaching.values())
    answer = planning.call("/check_state_validity", request)
    assert not answer.valid
    assert {contact.contact_body_2 for contact in answer.contacts} == {"<octomap>"}


def test_what_is_known_as_an_object_is_cut_out_and_comes_back(planning):
    eventually(planning, lambda: len(of_cylinder(planning)) > 10, "the cylinder is in the map")
    thing = CollisionObject(id="cylinder", operation=CollisionObject.ADD)
    thing.header.frame_id = "world"
    size = [HEIGHT_M, RADIUS_M]
    thing.primitives = [SolidPrimitive(type=SolidPrimitive.CYLINDER, dimensions=size)]
    thing.pose.position.x, thing.pose.position.y = PLACE
    thing.pose.position.z = FLOOR_M + HEIGHT_M / 2
    assert planning.apply_object(thing)
    eventually(planning, lambda: not len(of_cylinder(planning)), "the cylinder is cut out")
    thing.operation = CollisionObject.REMOVE
    assert planning.apply_object(thing)
    eventually(planning, lambda: len(of_cylinder(planning)) > 10, "the cylinder is back")


def test_a_cleared_map_is_made_again(planning):
    eventually(planning, lambda: len(of_cylinder(planning)) > 10, "the cylinder is in the map")
    planning.client.call(Empty, "/clear_octomap", Empty.Request())
    eventually(planning, lambda: len(of_cylinder(planning)) > 10, "the cylinder is back")
    assert len(centres(planning)[0]) > 200
