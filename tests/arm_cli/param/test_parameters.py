"""Parameter values of the command line and of files."""

from pathlib import Path

import pytest
from rcl_interfaces.msg import ParameterType, ParameterValue

from arm_cli.errors import MessageError, NoSuchNameError
from arm_cli.param import read_parameters
from arm_cli.ros.parameters import LABELS, TYPE_NAMES, read_value, write_value
from arm_node.parameter_file import nested_parameters, parameters_text


@pytest.mark.parametrize(
    ("text", "type_", "content"),
    [
        ("true", ParameterType.PARAMETER_BOOL, True),
        ("7", ParameterType.PARAMETER_INTEGER, 7),
        ("0.5", ParameterType.PARAMETER_DOUBLE, 0.5),
        ("hello", ParameterType.PARAMETER_STRING, "hello"),
        ("[1, 2]", ParameterType.PARAMETER_INTEGER_ARRAY, [1, 2]),
        ("[1.0, 0.5]", ParameterType.PARAMETER_DOUBLE_ARRAY, [1.0, 0.5]),
        ("[1, 0.5]", ParameterType.PARAMETER_DOUBLE_ARRAY, [1.0, 0.5]),
        ("[true]", ParameterType.PARAMETER_BOOL_ARRAY, [True]),
        ("[a, b]", ParameterType.PARAMETER_STRING_ARRAY, ["a", "b"]),
        ("[a, 1]", ParameterType.PARAMETER_STRING, "[a, 1]"),
        ("{a: 1}", ParameterType.PARAMETER_STRING, "{a: 1}"),
        ("a: b: c", ParameterType.PARAMETER_STRING, "a: b: c"),
        ("", ParameterType.PARAMETER_STRING, ""),
        ("2024-02-30", ParameterType.PARAMETER_STRING, "2024-02-30"),
        (f"{2**63 - 1}", ParameterType.PARAMETER_INTEGER, 2**63 - 1),
        (f"{2**63}", ParameterType.PARAMETER_STRING, f"{2**63}"),
        (f"[{-(2**63)}]", ParameterType.PARAMETER_INTEGER_ARRAY, [-(2**63)]),
        (f"[1, {2**63}]", ParameterType.PARAMETER_STRING, f"[1, {2**63}]"),
        (f"[0.5, {10**400}]", ParameterType.PARAMETER_STRING, f"[0.5, {10**400}]"),
    ],
)
def test_a_word_becomes_a_value_of_its_yaml_type(text, type_, content):
    value = ParameterValue()
    write_value(value, text)
    assert (value.type, read_value(value)) == (type_, content)


def test_names_and_labels_are_in_the_order_of_the_types():
    assert TYPE_NAMES[ParameterType.PARAMETER_DOUBLE_ARRAY] == "double array"
    assert LABELS[ParameterType.PARAMETER_STRING_ARRAY] == "String values are:"
    assert read_value(ParameterValue()) is None


def test_a_dumped_file_is_read_with_the_same_values(tmp_path):
    values = {"e.h": ["1e3", "08"], "x.a": 1, "x.a.b": 2, "c": 3, "c.d": 4, "e.f.g": "y"}
    text = parameters_text({"/n": {"ros__parameters": nested_parameters(values)}})
    assert read(tmp_path, text, "/n") == values


def read(tmp_path: Path, text: str, *sections: str):
    path = tmp_path / "params.yaml"
    path.write_text(text)
    return read_parameters(path, list(sections))


def test_a_file_is_read_for_its_node(tmp_path):
    text = "/n:\n  ros__parameters: {a: {b: 1}, c: 2}\n/**:\n  ros__parameters: {c: 3, d: 4}\n"
    assert read(tmp_path, text, "/**", "/n") == {"a.b": 1, "c": 2, "d": 4}


def test_a_file_may_leave_out_the_slash(tmp_path):
    assert read(tmp_path, "n:\n  ros__parameters: {a: 1}\n", "/n") == {"a": 1}


@pytest.mark.parametrize(
    ("text", "error", "sentence"),
    [
        ("/m:\n  ros__parameters: {a: 1}\n", NoSuchNameError, "no section for /n, only for /m"),
        ("/n: {a: 1}\n", MessageError, "no 'ros__parameters:' below"),
        ("[1]\n", MessageError, "is not a parameter file"),
        ("{", MessageError, "is not YAML: line 2"),
    ],
)
def test_a_file_that_does_not_fit_is_refused(tmp_path, text, error, sentence):
    with pytest.raises(error, match=sentence):
        read(tmp_path, text, "/n")


def test_a_missing_file_is_reported(tmp_path):
    with pytest.raises(NoSuchNameError, match="no parameter file"):
        read_parameters(tmp_path / "none.yaml", ["/n"])
