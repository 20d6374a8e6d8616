import math
from dataclasses import replace

import numpy as np
import pytest
from planning_scenes import CUBE, LINKS, MODEL, SCENE, at

from arm_description import forward_kinematics
from arm_node.rigid_transform import RigidTransform
from arm_planning.errors import MoveItErrorCode, PlanningError
from arm_planning.scene.frames import LinkPoses, frame_pose
from arm_planning.scene.objects import AttachedBody, CollisionObject

CUP = CollisionObject("cup", at(y=1), (CUBE,), {"rim": at(z=1)})
FULL = replace(
    SCENE,
    objects={"box": CollisionObject("box", at(1), (CUBE,), {"top": at(z=0.1), "a/b": at(z=0.2)})},
    attached={"cup": AttachedBody(CUP, "hand")},
    transforms={"camera": at(5), "box": at(9)},
)


def test_links_are_where_forward_kinematics_puts_them():
    positions = {"turn": 0.7, "slide": -0.3}
    links = LinkPoses(MODEL, positions)
    for name, expected in forward_kinematics(MODEL.robot, positions).items():
        assert np.array(links[name].matrix()) == pytest.approx(expected, abs=1e-12), name


@pytest.mark.parametrize(
    ("name", "position"),
    [
        ("", (0, 0, 0)),
        ("odom", (0, 0, 0)),
        ("base", (0, 0, 0)),
        ("/hand", (1.5, 0, 1)),
        ("box", (1, 0, 0)),
        ("box/top", (1, 0, 0.1)),
        ("box/a/b", (1, 0, 0.2)),
        ("cup", (1.5, 1, 1)),
        ("cup/rim", (1.5, 1, 2)),
        ("camera", (5, 0, 0)),
    ],
)
def test_a_frame_is_found_by_its_name(name: str, position: tuple[float, float, float]):
    assert frame_pose(FULL, LINKS, name).position == pytest.approx(position)


def test_a_subframe_turns_with_its_object():
    half = math.sqrt(0.5)
    turned = replace(FULL.objects["box"], pose=RigidTransform((1, 0, 0), (half, 0, 0, half)))
    scene = replace(FULL, objects={"box": turned})
    assert frame_pose(scene, LINKS, "box/top").position == pytest.approx((1, -0.1, 0))


@pytest.mark.parametrize(
    ("name", "hint"),
    [
        ("hnad", "did you mean 'hand'"),
        ("box/tip", "did you mean 'box/top'"),
        ("cup/", "did you mean 'cup'"),
        ("qqq", "the frames are a"),
    ],
)
def test_an_unknown_frame_is_refused_with_near_ones(name: str, hint: str):
    with pytest.raises(PlanningError) as caught:
        frame_pose(FULL, LINKS, name)
    assert caught.value.code is MoveItErrorCode.FRAME_TRANSFORM_FAILURE
    assert str(caught.value).startswith(f"Unknown frame: {name}; {hint}")
