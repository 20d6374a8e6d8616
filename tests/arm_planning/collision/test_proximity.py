import numpy as np
import pytest
from planning_models import model_of
from robots import joint, link, robot

from arm_node.rigid_transform import RigidTransform
from arm_planning.collision.model import CollisionModel
from arm_planning.collision.proximity import Proximity
from arm_planning.scene.objects import CollisionObject, PlacedShape
from arm_planning.scene.scene import PlanningScene
from arm_planning.scene.shapes import Box

BALL = "<collision><geometry><sphere radius='0.1'/></geometry></collision>"
SLIDER = robot(
    link("base", BALL),
    link("sledge", BALL),
    joint("slide", "base", "sledge", kind="prismatic", axis="1 0 0", xyz="1 0 0"),
)
WALL = CollisionObject(
    "wall", RigidTransform((2.0, 0.0, 0.0)), (PlacedShape(Box((0.2, 1.0, 1.0))),)
)


@pytest.fixture(scope="module")
def model() -> CollisionModel:
    scene = PlanningScene({}, {"wall": WALL})
    return CollisionModel(model_of(SLIDER, arm=(("slide",), "sledge")), scene, "arm")


def near(model: CollisionModel, q: float, within_m: float) -> dict[tuple[str, str], float]:
    proximity = Proximity(model)
    found = proximity.near(np.array([q]), within_m)
    return {proximity.names(pair): distance for pair, distance in found.items()}


def test_only_what_is_near_has_a_distance(model):
    assert near(model, 0.0, 0.05) == {}
    assert near(model, 0.78, 0.05) == pytest.approx({("sledge", "wall"): 0.02})
    assert near(model, -0.76, 0.05) == pytest.approx({("base", "sledge"): 0.04})


def test_in_contact_the_distance_is_negative(model):
    assert near(model, 0.81, 0.05) == pytest.approx({("sledge", "wall"): -0.01})


def test_it_says_what_belongs_to_the_world(model):
    proximity = Proximity(model)
    assert [proximity.is_with_world(pair) for pair in proximity.near(np.array([0.78]), 0.05)] == [
        True
    ]
    assert [proximity.is_with_world(pair) for pair in proximity.near(np.array([-0.76]), 0.05)] == [
        False
    ]


def test_the_model_checks_states_as_before(model):
    near(model, 0.79, 0.05)
    assert model.is_free(np.array([0.79]))
