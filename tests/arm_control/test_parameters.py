"""Parameters described by a dataclass."""

from dataclasses import dataclass
from math import inf, nan

import pytest

from arm_control.errors import ParameterError
from arm_control.parameters import (
    build_parameters,
    check_values,
    known_parameters,
    parameter,
    specs_of,
)


@dataclass(frozen=True, slots=True)
class Gains:
    p: float = parameter(1.0, "Proportional", read_only=True)


@dataclass(frozen=True, slots=True)
class Example:
    joint: str = parameter("j0", "The joint")
    count: int = parameter(3, "How many")
    on: bool = parameter(False, "Whether")
    names: tuple[str, ...] = parameter((), "Some names")
    limits: tuple[float, ...] = parameter((1.0,), "Some numbers")
    gains: Gains = Gains()


def test_specs_name_type_and_rules():
    specs = {spec.name: spec for spec in specs_of(Example)}
    assert list(specs) == ["joint", "count", "on", "names", "limits", "gains.p"]
    assert (specs["names"].type, specs["names"].is_list, specs["names"].default) == (str, True, ())
    assert (specs["gains.p"].read_only, specs["joint"].read_only) == (True, False)
    assert specs["gains.p"].description == "Proportional"


def test_missing_values_have_their_defaults():
    assert build_parameters(Example, {}) == Example()


def test_values_are_taken_by_full_name():
    built = build_parameters(Example, {"gains.p": 2.0, "names": ["a", "b"], "on": True})
    assert built == Example(gains=Gains(2.0), names=("a", "b"), on=True)


def test_an_integer_serves_as_a_float():
    built = build_parameters(Example, {"gains.p": 2, "limits": [1, 2.5]})
    assert (built.gains.p, built.limits) == (2.0, (1.0, 2.5))
    assert isinstance(built.gains.p, float)


@pytest.mark.parametrize(
    ("name", "value", "says"),
    [
        ("count", 1.5, "'count' must be of type int, not 1.5"),
        ("count", True, "'count' must be of type int, not True"),
        ("gains.p", True, "'gains.p' must be of type float, not True"),
        ("joint", 3, "'joint' must be of type str, not 3"),
        ("on", 1, "'on' must be of type bool, not 1"),
        ("names", "j0", "'names' must be a list, not 'j0'"),
        ("names", 3, "'names' must be a list, not 3"),
        ("names", ["a", 2], r"'names\[1\]' must be of type str, not 2"),
    ],
)
def test_a_wrong_type_is_refused(name, value, says):
    with pytest.raises(ParameterError, match=says):
        build_parameters(Example, {name: value})


@dataclass(frozen=True, slots=True)
class Bounded:
    share: int = parameter(3, "In percent", above=-1, at_most=99)


@pytest.mark.parametrize("value", [0, 99])
def test_a_value_at_its_bounds_is_taken(value):
    assert build_parameters(Bounded, {"share": value}) == Bounded(value)


@pytest.mark.parametrize("value", [-1, 100])
def test_a_value_beyond_its_bounds_is_refused(value):
    with pytest.raises(ParameterError, match=r"must be above -1 and at most 99, but is -?1"):
        build_parameters(Bounded, {"share": value})


@dataclass(frozen=True, slots=True)
class Ranges:
    above: float = parameter(1.0, "More than nothing", above=0)
    count: int = parameter(1, "At least one", above=0)
    least: float = parameter(0.0, "Not less than nothing", at_least=0.0)
    most: int = parameter(0, "At most nine", at_most=9)
    free: float = parameter(0.0, "Anything")
    numbers: tuple[float, ...] = parameter((), "Each more than nothing", above=0)


def test_bounds_make_a_range():
    ranges = {spec.name: spec.range for spec in specs_of(Ranges)}
    assert ranges == {
        "above": (0, inf),
        "count": (1, inf),
        "least": (0.0, inf),
        "most": (-inf, 9),
        "free": None,
        "numbers": None,
    }


@pytest.mark.parametrize("value", [-0.1, nan, inf])
def test_at_least_means_a_finite_number(value):
    with pytest.raises(ParameterError, match=r"'least' must be at least 0, but is "):
        build_parameters(Ranges, {"least": value})


def test_an_instance_made_by_hand_can_be_checked():
    check_values(Ranges(), specs_of(Ranges))
    with pytest.raises(ParameterError, match=r"'group.most' must be at most 9, but is 10"):
        check_values(Ranges(most=10), specs_of(Ranges, "group."), "group.")


def test_an_unknown_name_is_refused_with_those_there_are():
    with pytest.raises(ParameterError, match=r"unknown parameter gain; known: joint, count, on"):
        build_parameters(Example, {"gain": 1.0})


def test_of_many_parameters_the_five_nearest_are_named_and_where_the_list_is():
    many = [f"gains.j{joint}.{term}" for joint in range(9) for term in ("p", "i", "i_clamp_max")]
    known = [*many, "constraints.goal_time", "constraints.stopped_velocity_tolerance", "joints"]
    said = known_parameters("constrains.goal_time", known)
    assert said.startswith("the nearest of 30 are constraints.goal_time, ")
    assert said.count(",") == 4
    assert said.endswith("; arm param list shows all")
    assert "the nearest of 30 are joints" in known_parameters("joint", known)


def test_a_text_that_yaml_reads_as_a_number_needs_quotes():
    with pytest.raises(ParameterError, match="type str, not 1; a text that looks like a number"):
        build_parameters(Example, {"joint": 1})


def test_a_field_that_cannot_be_a_parameter_is_the_authors_mistake():
    @dataclass(frozen=True)
    class Bad:
        table: dict[str, int]

    with pytest.raises(ParameterError, match="field 'table' of Bad needs a default and one of"):
        specs_of(Bad)
