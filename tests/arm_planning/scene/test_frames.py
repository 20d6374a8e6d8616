import math
from dataclasses import replace

import numpy as np
import pytest
from planning_models import model_of
from planning_scenes import CUBE, LINKS, MODEL, SCENE, at
from robots import joint, link, robot

from arm_description import forward_kinematics
from arm_node.rigid_transform import RigidTransform
from arm_planning.errors import MoveItErrorCode, PlanningError
from arm_planning.scene.frames import LinkPoses, frame_pose
from arm_planning.scene.objects import AttachedBody, CollisionObject

GRIPPING = model_of(
    robot(
        *(link(name) for name in ("base", "upper", "hand", "left", "right")),
        joint("shoulder", "base", "upper", xyz="0.1 0 0.2", axis="0 0.6 0.8"),
        joint("rail", "upper", "hand", xyz="0 0.3 0", axis="1 0 0", kind="prismatic"),
        joint("grip", "hand", "left", xyz="0 0 0.1", axis="0 0 1"),
        joint("follow", "hand", "right", "<mimic joint='grip' multiplier='-1'/>", xyz="0 0 0.1"),
    ),
    arm=(("shoulder", "rail"), "hand"),
)
CUP = CollisionObject("cup", at(y=1), (CUBE,), {"rim": at(z=1)})
FULL = replace(
    SCENE,
    objects={"box": CollisionObject("box", at(1), (CUBE,), {"top": at(z=0.1), "a/b": at(z=0.2)})},
    attached={"cup": AttachedBody(CUP, "hand")},
    transforms={"camera": at(5), "box": at(9)},
)


@pytest.mark.parametrize(
    ("model", "positions"),
    [
        (MODEL, {"turn": 0.7, "slide": -0.3}),
        (GRIPPING, {"shoulder": 0.3, "rail": -0.1, "grip": 0.8}),
    ],
    ids=["slider", "with_mimic"],
)
def test_links_are_where_forward_kinematics_puts_them(model, positions):
    links = LinkPoses(model, positions)
    for name, expected in forward_kinematics(model.robot, positions).items():
        assert np.array(links[name].matrix()) == pytest.approx(expected, abs=1e-12), name


def test_an_unknown_link_is_refused_with_those_that_exist():
    with pytest.raises(PlanningError, match="no link 'foot'; the robot has base, upper") as refused:
        LinkPoses(GRIPPING, {}).of("foot")
    assert refused.value.code is MoveItErrorCode.INVALID_LINK_NAME


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
def test_a_frame_is_found_by_its_name(name, position):
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
def test_an_unknown_frame_is_refused_with_near_ones(name, hint):
    with pytest.raises(PlanningError) as caught:
        frame_pose(FULL, LINKS, name)
    assert caught.value.code is MoveItErrorCode.FRAME_TRANSFORM_FAILURE
    assert str(caught.value).startswith(f"Unknown frame: {name}; {hint}")
