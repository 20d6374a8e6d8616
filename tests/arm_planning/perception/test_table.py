"""What is found on tables that a depth camera sees."""

from math import atan2, cos, pi, radians, sin

import numpy as np
import pytest

from arm_node.rigid_transform import RigidTransform
from arm_planning.errors import PerceptionError
from arm_planning.perception.table import find_things
from arm_planning.perception.testing import (
    TableThing,
    camera_at,
    faults,
    is_found,
    look,
    noisy,
    random_table,
    tutorial_camera,
)

FROM_45 = camera_at(radians(45))
VIEWS = {
    "45 degrees": FROM_45,
    "20 degrees": camera_at(radians(20)),
    "above": camera_at(pi / 2),
    "tutorial": tutorial_camera(),
}
NOISE_AT_1M = 0.002
BOX = TableThing("box", (0.0, 0.0), 0.4, (0.05, 0.07, 0.06))
CYLINDER = TableThing("cylinder", (0.02, 0.1), 0.0, (0.02, 0.12))


def seen(*things, camera=FROM_45, noise=0.0):
    points = noisy(look(camera, things).points, np.random.default_rng(0), noise)
    return find_things(points, camera.pose).things


@pytest.mark.parametrize("camera", VIEWS.values(), ids=VIEWS)
@pytest.mark.parametrize("seed", [0, 7])
def test_the_things_of_a_random_table_are_found(camera, seed):
    random = np.random.default_rng(seed)
    table = random_table(random, camera)
    sight = look(camera, table)
    found = find_things(noisy(sight.points, random, NOISE_AT_1M), camera.pose).things
    assert not faults(table, sight, found)


def test_without_noise_pose_and_size_are_right_to_a_millimetre():
    (box,) = seen(BOX)
    np.testing.assert_allclose(box.pose.position, (0, 0, 0.03), atol=1e-3)
    np.testing.assert_allclose(sorted(box.size), sorted(BOX.size), atol=1e-3)


def test_a_box_has_its_yaw():
    (box,) = seen(TableThing("box", (0.0, 0.0), 0.4, (0.08, 0.04, 0.06)))
    _, _, yaw = box.pose.rpy()
    along = yaw if box.size[0] > box.size[1] else yaw + pi / 2
    # A half turn shows the same box.
    assert atan2(sin(2 * (along - 0.4)), cos(2 * (along - 0.4))) / 2 == pytest.approx(0, abs=0.02)


def test_things_that_touch_are_two():
    near = TableThing("cylinder", (-0.03, 0.0), 0.0, (0.03, 0.05))
    behind = TableThing("box", (0.03, 0.0), 0.0, (0.06, 0.06, 0.12))
    found = seen(near, behind, noise=NOISE_AT_1M)
    assert sorted(one.kind for one in found) == ["box", "cylinder"]
    assert any(is_found(near, one) and not one.partial for one in found)


def test_what_a_nearer_thing_hides_in_part_is_partial():
    tall = TableThing("cylinder", (-0.1, 0.0), 0.0, (0.03, 0.15))
    hidden = TableThing("box", (0.03, 0.02), 0.3, (0.06, 0.06, 0.05))
    found = seen(tall, hidden, noise=NOISE_AT_1M)
    assert [one.partial for one in found if one.kind == "cylinder" and is_found(tall, one)] == [
        False
    ]
    assert all(one.partial for one in found if not is_found(tall, one))
    assert len(found) > 1


def test_what_the_edge_of_the_picture_cuts_is_partial():
    found = seen(TableThing("box", (0.0, 0.42), 0.0, (0.09, 0.09, 0.05)))
    assert [one.partial for one in found] == [True]


def test_what_is_higher_than_the_camera_is_partial():
    found = seen(TableThing("box", (0.2, 0.0), 0.2, (0.08, 0.08, 0.6)))
    assert found
    assert all(one.partial for one in found)


def test_what_is_neither_box_nor_cylinder_is_partial():
    # Two boxes of one height that touch in an L.
    long = TableThing("box", (0.0, 0.0), 0.0, (0.05, 0.12, 0.05))
    foot = TableThing("box", (0.06, -0.035), 0.0, (0.07, 0.05, 0.05))
    assert [one.partial for one in seen(long, foot, camera=camera_at(pi / 2))] == [True]


def test_poses_are_in_the_frame_of_the_cameras_pose():
    moved = RigidTransform((1.0, 2.0, 0.5), (0.0, 0.0, sin(0.3), cos(0.3)))
    points = look(FROM_45, [CYLINDER]).points.astype(np.float32)
    (cylinder,) = find_things(points, moved.then(FROM_45.pose)).things
    expected = moved.then(RigidTransform((*CYLINDER.position, 0.06))).position
    np.testing.assert_allclose(cylinder.pose.position, expected, atol=1e-3)


def test_pixels_without_points_do_no_harm():
    points = look(FROM_45, [BOX]).points.astype(np.float32)
    points[np.random.default_rng(0).random(points.shape[:2]) < 0.01] = np.nan
    points[:40] = np.nan
    (box,) = find_things(points, FROM_45.pose).things
    assert is_found(BOX, box)


def test_an_empty_table_has_no_things():
    assert seen(noise=NOISE_AT_1M) == ()


def test_a_box_beside_clutter_is_found():
    box = TableThing("box", (0.0, -0.2), 0.4, (0.05, 0.07, 0.06))
    points = look(FROM_45, [box]).points
    # Heights at random, as no upright thing has them.
    points[200:300, 200:400] *= np.random.default_rng(0).uniform(0.7, 0.95, (100, 200, 1))
    found = find_things(points.astype(np.float32), FROM_45.pose).things
    assert any(is_found(box, one) and not one.partial for one in found)


@pytest.mark.parametrize(
    ("points", "reason"),
    [
        (np.full((48, 64, 3), np.nan), "the depth camera sees no points"),
        (np.ones((48, 64, 3)), "the depth camera sees no level plane"),
        (look(FROM_45, []).points * (1, -1, 1), "the depth camera sees no level plane"),
    ],
    ids=["nothing", "one point", "a ceiling"],
)
def test_without_a_level_plane_an_error_says_so(points, reason):
    with pytest.raises(PerceptionError, match=reason):
        find_things(points.astype(np.float32), FROM_45.pose)
