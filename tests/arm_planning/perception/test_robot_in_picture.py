"""A robot in the picture is not a thing, and what it hides is known in part only."""

import numpy as np
import pytest
from robots import collision, joint, link, robot

from arm_node.rigid_transform import RigidTransform
from arm_planning.collision.body_filter import SeenRobot
from arm_planning.perception.table import find_things
from arm_planning.perception.table_objects import Crop, objects_in_view
from arm_planning.perception.testing import TableThing, is_found, look, noisy, tutorial_camera

ROBOT = SeenRobot(
    robot(
        link("base"),
        link("arm", collision("box", xyz="0 0 0.15", size="0.04 0.05 0.3")),
        joint("slide", "base", "arm", kind="prismatic", axis="1 0 0", limits=(0.0, 1.0)),
    )
)
CAMERA = tutorial_camera()
ARM = TableThing("box", (0.55, 0.0), 0.0, (0.04, 0.05, 0.3))
"""The arm as a camera sees it."""
BESIDE = TableThing("box", (0.6, -0.15), 0.4, (0.05, 0.07, 0.06))
BEHIND = TableThing("cylinder", (0.75, 0.03), 0.0, (0.03, 0.1))


def points_of(*things):
    return noisy(look(CAMERA, things).points, np.random.default_rng(0), 0.001)


def arm_in(points, x=ARM.position[0]):
    arm = CAMERA.pose.inverse().then(RigidTransform((x, 0.0, 0.0)))
    return ROBOT.pixels(points, {"arm": arm}.get)


def test_only_the_thing_beside_the_robot_is_left():
    points = points_of(ARM, BESIDE)
    assert len(find_things(points, CAMERA.pose).things) == 2
    (thing,) = find_things(points, CAMERA.pose, arm_in(points)).things
    assert is_found(BESIDE, thing)
    assert not thing.partial


def test_with_the_robot_alone_there_are_no_things():
    points = points_of(ARM)
    assert find_things(points, CAMERA.pose, arm_in(points)).things == ()


def test_where_the_robot_is_not_nothing_is_cut_out():
    points = points_of(ARM)
    assert len(find_things(points, CAMERA.pose, arm_in(points, x=0.2)).things) == 1


def test_what_the_robot_hides_in_part_is_partial():
    points = points_of(ARM, BEHIND)
    (thing,) = find_things(points, CAMERA.pose, arm_in(points)).things
    assert thing.partial


@pytest.mark.parametrize("noise_m", [0.0, 0.002])
@pytest.mark.parametrize("thing", [BESIDE, BEHIND], ids=lambda thing: thing.kind)
def test_a_thing_that_is_cut_as_part_of_the_robot_is_partial(thing, noise_m):
    points = noisy(look(CAMERA, [thing]).points, np.random.default_rng(0), noise_m)
    matrix = np.array(CAMERA.pose.matrix())
    right = (points @ matrix[:3, :3].T + matrix[:3, 3])[..., 1] < thing.position[1]
    (rest,) = find_things(points, CAMERA.pose, right).things
    assert rest.partial


def test_what_the_crop_cuts_is_partial_and_the_robot_is_no_object():
    points = points_of(ARM, BESIDE)
    crop = Crop((0.0, -0.16, -1.0), (1.0, 1.0, 1.0))
    seen = objects_in_view(points, CAMERA.pose, crop, "table", 0.01, arm_in(points))
    assert [(each.id[:3], thing.partial) for each, thing in seen.things] == [("box", True)]
