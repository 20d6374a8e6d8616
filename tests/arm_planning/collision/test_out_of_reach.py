"""What nothing can reach is not looked at, and comes back when it moves."""

from dataclasses import replace

import numpy as np
import pytest
from planning_models import model_of
from robots import joint, link, robot

from arm_node.rigid_transform import RigidTransform
from arm_planning.collision.model import CollisionModel
from arm_planning.collision.proximity import Proximity
from arm_planning.collision.reach import MANY, never_touching
from arm_planning.scene.objects import CollisionObject, PlacedShape
from arm_planning.scene.scene import PlanningScene
from arm_planning.scene.shapes import Plane, Sphere

BALL = "<collision><origin xyz='0.5 0 0'/><geometry><sphere radius='0.1'/></geometry></collision>"


def arm(kind: str = "revolute") -> str:
    return robot(
        link("base", BALL), link("rod", BALL), joint("turn", "base", "rod", kind=kind, xyz="0 0 2")
    )


def ball(*xs: float) -> CollisionObject:
    """Return balls of 0.1 m beside the arm's joint; the arm's own reaches 0.6 m, so to 0.7 m."""
    shapes = tuple(PlacedShape(Sphere(0.1), RigidTransform((x, 0.0, 0.0))) for x in xs)
    return CollisionObject("thing", RigidTransform((0.0, 0.0, 2.0)), shapes)


def model(
    thing: CollisionObject, kind: str = "revolute", like: CollisionModel | None = None
) -> CollisionModel:
    others = [replace(ball(50.0), id=f"other{n}") for n in range(MANY)]
    scene = PlanningScene({}, {each.id: each for each in (thing, *others)})
    return CollisionModel(model_of(arm(kind), arm=(("turn",), "rod")), scene, "arm", like=like)


def is_left_out(model: CollisionModel) -> bool:
    names = [body.name if body is not None else "" for body in model.posed.bodies]
    return bool(never_touching(model.posed.model, model.posed.data)[names.index("thing")])


@pytest.mark.parametrize(
    ("xs", "left_out"), [((0.69,), False), ((0.71,), True), ((3.0, 0.6), False)]
)
def test_only_what_nothing_can_touch_is_left_out(xs, left_out):
    checked = model(ball(*xs))
    assert is_left_out(checked) == left_out
    assert checked.is_free(np.zeros(1)) == left_out


def test_a_plane_is_never_out_of_reach():
    plane = PlacedShape(Plane(1.0, 0.0, 0.0, 5.0))
    assert not is_left_out(model(CollisionObject("thing", RigidTransform(), (plane,))))


def test_a_sliding_joint_may_reach_everything():
    assert not is_left_out(model(ball(3.0), kind="prismatic"))


def test_what_moves_into_reach_is_looked_at_again():
    far = model(ball(0.71))
    assert not model(ball(0.69), like=far).is_free(np.zeros(1))
    assert model(ball(0.71), like=model(ball(0.69))).is_free(np.zeros(1))


def test_what_is_out_of_reach_may_be_near():
    far = model(ball(0.73))
    near = Proximity(far).near(np.zeros(1), 0.05)
    assert list(near.values()) == pytest.approx([0.03])
    assert far.is_free(np.zeros(1))


def test_an_arm_alone_finds_itself_though_no_body_is_searched_for():
    links = link("base", BALL), link("rod"), link("tip", BALL)
    joints = joint("turn", "base", "rod"), joint("bend", "rod", "tip", axis="0 1 0", xyz="0 0 0.3")
    robot_model = model_of(robot(*links, *joints), arm=(("turn", "bend"), "tip"))
    alone = CollisionModel(robot_model, PlanningScene({}), "arm")
    assert not alone.posed.model.body_contype.any()
    assert alone.is_free(np.zeros(2))
    assert not alone.is_free(np.array([0.0, 0.5]))
