"""Which points show a robot."""

import numpy as np
import pytest

from arm_node.rigid_transform import RigidTransform
from arm_planning.collision.body_filter import SeenRobot
from arm_planning.errors import PlanningError

SHAPE = "<origin xyz='{x} 0 0'/><geometry>{geometry}</geometry>"
BOX = "<box size='0.2 0.2 0.2'/>"
MISSING = "<mesh filename='file:///missing.stl'/>"


def robot(visual=BOX, collision=BOX, padding_m=0.0):
    urdf = (
        "<robot name='rod'><link name='rod'>"
        f"<visual>{SHAPE.format(x=0, geometry=visual)}</visual>"
        f"<collision>{SHAPE.format(x=1, geometry=collision)}</collision></link></robot>"
    )
    return SeenRobot(urdf, padding_m)


def shown(seen, *points, x=0.0):
    picture = np.array([points], np.float32)
    return seen.pixels(picture, {"rod": RigidTransform((x, 0.0, 0.0))}.get)[0].tolist()


def test_what_the_robot_looks_like_and_what_it_collides_with_show_it():
    points = (0, 0, 0), (1, 0, 0), (0.5, 0, 0)
    assert shown(robot(), *points) == [True, True, False]
    assert shown(robot(), *points, x=0.5) == [False, False, True]


def test_shapes_are_grown():
    assert shown(robot(padding_m=0.05), (0.13, 0, 0), (0.16, 0, 0)) == [True, False]


def test_pixels_without_a_point_and_links_without_a_pose_show_nothing():
    nothing = (np.nan,) * 3
    assert shown(robot(), nothing, (0, 0, 0)) == [False, True]
    picture = np.zeros((2, 3, 3), np.float32)
    assert not robot().pixels(picture, {}.get).any()


def test_a_look_that_cannot_be_used_is_left_out_with_a_warning(caplog):
    assert shown(robot(visual=MISSING), (0, 0, 0), (1, 0, 0)) == [False, True]
    assert "link 'rod'" in caplog.text
    assert "missing.stl" in caplog.text


def test_a_collision_shape_that_cannot_be_used_is_an_error():
    with pytest.raises(PlanningError, match=r"link 'rod': .*missing.stl"):
        robot(collision=MISSING)
