"""Names that a regular expression matches, and invalid expressions."""

import re

import pytest
from hypothesis import given
from hypothesis import strategies as st

from arm_gazebo.errors import RequestError
from arm_gazebo.world.entity_motion import NamePattern

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
