import pytest
import yaml
from hypothesis import given
from hypothesis import strategies as st

from arm_node.limited_yaml import MAX_DEPTH, YamlError, load_yaml, load_yaml_documents

PLAIN = st.recursive(
    st.none() | st.booleans() | st.integers() | st.floats(allow_nan=False) | st.text(),
    lambda inner: st.lists(inner) | st.dictionaries(st.text(), inner),
    max_leaves=20,
)


def refusal(text: str) -> str:
    with pytest.raises(YamlError) as caught:
        load_yaml(text)
    assert "\n" not in str(caught.value)
    return str(caught.value)


def multiplied(levels: int, width: int = 10) -> str:
    lines = ["a0: &a0 x"]
    for level in range(1, levels):
        uses = ", ".join([f"*a{level - 1}"] * width)
        lines.append(f"a{level}: &a{level} [{uses}]")
    return "\n".join(lines)


@given(PLAIN)
def test_plain_values_come_back(value):
    assert load_yaml(yaml.safe_dump(value)) == value


def test_an_empty_text_is_nothing():
    assert load_yaml("") is None
    assert load_yaml_documents("") == []


def test_aliases_within_reason_are_what_they_name():
    assert load_yaml("a: &a {b: 1}\nc: {<<: *a, d: *a}") == {
        "a": {"b": 1},
        "c": {"b": 1, "d": {"b": 1}},
    }


def test_aliases_of_aliases_are_refused_before_they_are_followed(monkeypatch):
    # Who walks through the values of some more levels never ends, so the limit is lowered.
    monkeypatch.setattr("arm_node.limited_yaml.MAX_VALUES", 500)
    assert load_yaml(multiplied(3))
    problem = "line 4, column 25: it has more than 500 values, including aliases"
    assert refusal(multiplied(4)) == problem


def test_a_value_that_contains_itself_is_refused():
    assert refusal("a: &a [1, *a]") == "line 1, column 11: '*a' contains itself"


@pytest.mark.parametrize("brackets", ["[", "{a: ", "- "])
def test_values_that_nest_too_deep_are_refused(brackets):
    assert f"nested more than {MAX_DEPTH} deep" in refusal(brackets * (MAX_DEPTH + 1))


def test_aliases_cannot_nest_deeper_than_brackets():
    lines = ["a0: &a0 x", *(f"a{n}: &a{n} [*a{n - 1}]" for n in range(1, 100))]
    assert f"nested more than {MAX_DEPTH} deep" in refusal("\n".join(lines))


def test_values_may_nest_as_deep_as_the_limit_says():
    text = "[" * MAX_DEPTH + "]" * MAX_DEPTH
    assert str(load_yaml(text)) == text


@pytest.mark.parametrize(
    "text",
    [
        *("!!int ''", "!!bool x", "!!timestamp x", "!!float x", "!!binary ä", "2026-02-30"),
        *("!!python/object:os.system x", "{[1]: 2}", "? {a: b}", "*a", "a: b: c", "\x00", "'"),
        *("0x" + "f" * 5, "1" * 5000, "1:" * 5000 + "1", "!!omap x", "!!set x", "\ud800"),
    ],
)
def test_any_other_fault_is_a_sentence_or_a_value(text):
    problem = ""
    try:
        load_yaml(text)
    except YamlError as error:
        problem = str(error) or "nothing said"
    assert "\n" not in problem
    assert problem != "nothing said"


def test_a_fault_of_syntax_names_its_place():
    assert refusal("a: 1\nb: ]").startswith("line 2, column 4: ")


def test_one_value_is_expected():
    assert refusal("a: 1\n---\nb: 2") == "it has 2 documents instead of one"
