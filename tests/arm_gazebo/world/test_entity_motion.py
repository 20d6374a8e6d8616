"""Things by name, place and motion, and names that a regular expression matches."""

import re

import mujoco
import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from arm_gazebo.errors import RequestError
from arm_gazebo.physics.state_probe import WorldState
from arm_gazebo.physics.stepped_shapes import SteppedShapes
from arm_gazebo.world.entity import Category
from arm_gazebo.world.entity_motion import EntityFilter, EntityMotions, NamePattern, Volume

WORLD = """<mujoco><option><flag sleep="enable"/></option><worldbody>
  <geom type="plane" size="0 0 1"/>
  <body name="box" pos="0.6 0.5 0.15" sleep="init"><freejoint/>
    <geom name="hull" type="box" size="0.25 0.2 0.15"/>
    <geom name="label" type="box" size="0.1 0.1 0.151" contype="0" conaffinity="0"/></body>
</worldbody></mujoco>"""
PLACE = (0.6, 0.5, 0.15)


def present(model: mujoco.MjModel) -> WorldState:
    data = mujoco.MjData(model)
    return WorldState(0.0, data.qpos, data.qvel, data.mocap_pos, data.mocap_quat)


def test_drawn_shapes_of_a_sleeping_thing_are_in_place_whenever_they_are_first_asked_for():
    model = mujoco.MjModel.from_xml_string(WORLD)
    state = present(model)
    shapes = SteppedShapes(model)

    # A client of the running simulation makes its own arrays at any moment of a control period.
    shapes.hide()
    motions = EntityMotions(model)
    shapes.show()
    motions.take(state)

    positions, _ = motions.geom_poses
    assert tuple(positions[model.geom("label").id]) == PLACE


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


ITEMS = st.sampled_from(["a", "b", ".", "^", "$", "[ab]", "[^a]", r"\w", r"\b", ""])
TIMES = st.sampled_from(["*", "+", "?", "{2}", "{1,2}", "{2,}", "*?"])


def _larger(inner: st.SearchStrategy[str]) -> st.SearchStrategy[str]:
    pair = st.tuples(inner, inner)
    return st.one_of(
        pair.map("".join),
        pair.map("|".join).map("({})".format),
        st.tuples(inner, TIMES).map(lambda two: f"({two[0]}){two[1]}"),
    )


@given(st.recursive(ITEMS, _larger, max_leaves=6), st.text("ab", max_size=6))
def test_what_re_finds_is_found_and_nothing_else(pattern, name):
    assert NamePattern(pattern).is_in(name) is bool(re.search(pattern, name))


@pytest.mark.parametrize(
    ("pattern", "name", "found"),
    [
        ("^[[:alpha:]_]+[[:digit:]]{2}$", "coke_can42", True),
        ("^[[:alpha:]_]+[[:digit:]]{2}$", "coke_can4", False),
        ("[^[:alnum:]]", "a.b", True),
        ("^[][:punct:]]+$", "[].-", True),
        (r"^can(?:_\d)?$", "can_7", True),
        (r"a\.b", "axb", False),
        (r"^[\d.]+$", "1.2", True),
        ("^(red|green)_", "green_cube", True),
        ("^(red|)_", "_cube", True),
        ("^x{0}$", "", True),
        ("^(a{30}){30}$", "a" * 60, False),
    ],
)
def test_posix_expressions_with_escapes(pattern, name, found):
    assert NamePattern(pattern).is_in(name) is found


@pytest.mark.parametrize(
    "pattern",
    [
        *("(", ")", "a)", "[", "[]", "*", "a**", "|*", "a{2,1}", "(a{30}){300}", "(?P<a"),
        *("(?=a)", r"(a)\1", "\\", "[b-a]", "[[:letter:]]", r"\q", "a" * 201, "(" * 200, "\ud800"),
    ],
)
def test_an_invalid_expression_is_refused(pattern):
    with pytest.raises(RequestError, match="the filter"):
        NamePattern(pattern)


@pytest.mark.parametrize(
    "pattern",
    [
        r"(\w+)+!",
        "^(a|a)+(a|a)*$!",
        "(a|a)" * 39 + "!",
        ".*" * 99 + "!",
        "(" * 32 + "a*" + "b|a)*" * 32 + "!",
        "^((a{1,30}){1,30})!",
    ],
)
def test_patterns_with_exponential_backtracking_terminate(pattern):
    assert not NamePattern(pattern).is_in("a" * 100)
