"""Parameters as fields of a form, and what was typed as their values."""

import pytest
from hypothesis import given, settings
from hypothesis import strategies as st
from rcl_interfaces.msg import (
    FloatingPointRange,
    ParameterDescriptor,
    ParameterType,
    ParameterValue,
)

from arm_node.messages import MessageValueError
from arm_viewer.calls.form import FieldKind
from arm_viewer.calls.parameter_fields import VALUE_FIELDS, parameter_field, parameter_value

TEXTS = st.text(st.characters(codec="utf-8", exclude_characters="\0\r\n"), max_size=5)
CONTENTS = {
    ParameterType.PARAMETER_BOOL: st.booleans(),
    ParameterType.PARAMETER_INTEGER: st.integers(-(2**63), 2**63 - 1),
    ParameterType.PARAMETER_DOUBLE: st.floats(allow_nan=False),
    ParameterType.PARAMETER_STRING: TEXTS,
}
CONTENTS |= {kind + 5: st.lists(content, max_size=3) for kind, content in CONTENTS.items()}


@pytest.mark.parametrize("kind", CONTENTS)
@settings(max_examples=15)
@given(data=st.data())
def test_a_field_that_nobody_touches_gives_back_its_value(kind, data):
    value = ParameterValue(type=kind)
    content = data.draw(CONTENTS[kind])
    setattr(value, VALUE_FIELDS[kind], content)
    field = parameter_field(ParameterDescriptor(name="p", type=kind), value)
    read_kind, read = parameter_value(kind, field.text, "p")
    assert (read_kind, read) == (kind, content)


def test_a_field_has_the_range_and_the_words_of_the_descriptor():
    descriptor = ParameterDescriptor(
        name="speed",
        type=ParameterType.PARAMETER_DOUBLE,
        description="how fast",
        additional_constraints="above 0",
        read_only=True,
        floating_point_range=[FloatingPointRange(from_value=0.0, to_value=2.5)],
    )
    value = ParameterValue(type=ParameterType.PARAMETER_DOUBLE, double_value=1.0)
    field = parameter_field(descriptor, value)
    assert (field.kind, field.text, field.type) == (FieldKind.NUMBER, "1.0", "double")
    assert (field.least, field.most, field.is_fixed) == (0.0, 2.5, True)
    assert field.about == "how fast; above 0"


@pytest.mark.parametrize(
    ("text", "kind"), [("1", 2), ("1.0", 3), ("true", 1), ("a", 4), ("[1, 2.5]", 8), ("[a]", 9)]
)
def test_a_parameter_without_a_type_takes_that_of_the_text(text, kind):
    assert parameter_value(0, text, "p")[0] == kind


@pytest.mark.parametrize(
    ("kind", "text", "problem"),
    [
        (1, "1", "p: '1' is not a value of the type bool"),
        (2, "1.5", "not a value of the type integer"),
        (2, str(2**63), "not a value of the type integer"),
        (3, "fast", "not a value of the type double"),
        (8, "1.0", "not a value of the type double[]"),
        (9, "[1]", "not a value of the type string[]"),
        (7, "[1", "p: line 2"),
        (0, "{a: 1}", "cannot be the value of a parameter"),
        (0, "[]", "cannot be the value of a parameter"),
        (0, "", "cannot be the value of a parameter"),
    ],
)
def test_what_does_not_fit_is_refused_with_the_name(kind, text, problem):
    with pytest.raises(MessageValueError) as refused:
        parameter_value(kind, text, "p")
    assert problem in str(refused.value)
