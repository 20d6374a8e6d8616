import numpy as np
import pytest

from arm_gazebo.errors import RequestError
from arm_gazebo.world.entity import Category
from arm_gazebo.world.entity_motion import EntityFilter, Volume


@pytest.fixture
def choose(kept, parts, things):
    world = kept(robot=parts.pendulum())
    world.spawn("post_1", things.post, things.at(5, 5, 5))

    def names(**filters) -> set[str]:
        chosen = EntityFilter(**filters).choose(world.editor.entities, world.editor.motions())
        return {entity.name for entity in chosen}

    return names


def test_without_filters_everything_passes(choose):
    assert {"bench", "post_1", "mustard", "coke_can"} <= choose()


@pytest.mark.parametrize(
    ("pattern", "expected"),
    [("_can$", {"coke_can"}), ("^post_[0-9]+$", {"post_1"}), ("nothing", set())],
)
def test_names_by_regular_expression(choose, pattern, expected):
    assert choose(pattern=pattern) == expected


@pytest.mark.parametrize("pattern", ["(", "[", "*", "(?P<a", "a" * 201])
def test_an_invalid_regular_expression_is_refused(choose, pattern):
    with pytest.raises(RequestError):
        choose(pattern=pattern)


def test_categories(choose):
    assert choose(categories=frozenset({Category.ROBOT})) == {"bench"}
    assert choose(categories=frozenset({Category.STATIC_OBJECT})) == {"mustard", "post_1"}
    assert "bench" not in choose(categories=frozenset({Category.OBJECT}))
    assert choose(categories=frozenset({Category.HUMAN})) == set()


def test_one_tag_or_all(choose):
    assert choose(tags=frozenset({"spawned", "other"})) == {"post_1"}
    assert choose(tags=frozenset({"spawned", "other"}), all_tags=True) == set()


def test_volumes(choose):
    corner = np.array([4.9, 4.9, 4.9])
    assert choose(volume=Volume(corner, corner + 1)) == {"post_1"}
    assert choose(volume=Volume(corner - 1, corner - 0.5)) == set()
    # The post's nearest corner is 0.05 m before its middle, each way.
    middle = np.array([4.85, 4.95, 4.95])
    assert choose(volume=Volume(middle, middle, 0.11)) == {"post_1"}
    assert choose(volume=Volume(middle, middle, 0.09)) == set()
