"""Parameter values: types, substitutions, and the parameter file."""

import json
import math
import signal

import numpy as np
import pytest
import yaml
from run_python import run_python

from launch_py import LaunchContext
from launch_py.errors import NodeParameterError
from launch_py.ros.parameters import (
    ParameterValue,
    evaluate_parameters,
    parameter_file_text,
    read_yaml,
)
from launch_py.substitutions import LaunchConfiguration

URDF = '<?xml version="1.0"?>\n<robot name="a:b">\n  <link name="Ärm \'1\'" # {x}/>\n\t</robot>\n'


@pytest.fixture
def context():
    names = {"flag": "true", "rate": "100", "gain": "1.0e-2", "text": "3.x", "list": "[1, 2.5]"}
    return LaunchContext(launch_configurations={**names, "urdf": URDF})


def evaluated(context, value):
    return evaluate_parameters(context, {"p": value})["p"]


def round_trip(values):
    return yaml.safe_load(parameter_file_text("/a/b", values))["/a/b"]["ros__parameters"]


@pytest.mark.parametrize(
    "value",
    [
        True,
        3,
        -2.5,
        1e-7,
        1e300,
        "text",
        "yes",
        "1.0",
        "",
        URDF,
        "a\u2028b\x7fc\x00",
        "\U0001f600",
        [1, 2],
        [True, False],
        ["a", "1"],
        [0.5, 1.0],
    ],
)
def test_values_survive_the_file(context, value):
    result = round_trip({"p": evaluated(context, value)})["p"]
    assert result == value
    assert type(result) is type(value)


def test_infinities_and_nan_survive_the_file():
    result = round_trip({"a": math.inf, "b": -math.inf, "c": math.nan})
    assert (result["a"], result["b"]) == (math.inf, -math.inf)
    assert math.isnan(result["c"])


def test_nested_parameters_survive_the_file(context):
    values = evaluate_parameters(context, {"limits": {"j0": {"max": 1.5}}, "n": 1})
    assert round_trip(values) == {"limits": {"j0": {"max": 1.5}}, "n": 1}


@pytest.mark.parametrize(
    ("name", "expected"),
    [("flag", True), ("rate", 100), ("gain", 0.01), ("text", "3.x"), ("list", [1.0, 2.5])],
)
def test_the_text_of_a_substitution_is_read_as_yaml(context, name, expected):
    assert evaluated(context, LaunchConfiguration(name)) == expected


@pytest.mark.parametrize(
    "text",
    [
        *("yes", "On", "FALSE", "no", "off", "tRUE", "'yes'", "arm", "1.2.3", "nan", "infinity"),
        *("-inf", ".inf", "-.Inf", "0x10", "1_000", "-7", "+2.5", "[yes, off]", "['1', a]"),
    ],
)
def test_texts_are_read_as_pyyaml_reads_them(context, text):
    context.launch_configurations["t"] = text
    value = evaluated(context, LaunchConfiguration("t"))
    assert value == yaml.safe_load(text)
    assert isinstance(value, type(yaml.safe_load(text)))


def test_not_a_number_is_written_as_in_yaml(context):
    context.launch_configurations["t"] = ".nan"
    assert math.isnan(evaluated(context, LaunchConfiguration("t")))


@pytest.mark.parametrize("text", ["null", "~", "Null"])
def test_null_is_an_empty_text_as_in_ros(context, text):
    context.launch_configurations["t"] = text
    assert evaluated(context, LaunchConfiguration("t")) == ""


@pytest.mark.parametrize(
    ("value", "plain"),
    [
        (np.deg2rad(90), math.pi / 2),
        (np.float32(0.5), 0.5),
        (np.int64(3), 3),
        (np.bool_(True), True),
        (np.array([1.0, 2.5]), [1.0, 2.5]),
        (np.array([True, False]), [True, False]),
        ([np.float64(1.0), 2.5], [1.0, 2.5]),
        ([np.int32(1), 2], [1, 2]),
        (signal.SIGINT, 2),
    ],
)
def test_numbers_of_other_classes_are_written_plainly(context, value, plain):
    assert round_trip({"p": evaluated(context, value)})["p"] == plain
    given = ParameterValue(value)
    assert round_trip({"p": evaluated(context, given)})["p"] == plain


def test_a_robot_description_stays_text(context):
    assert evaluated(context, LaunchConfiguration("urdf")) == URDF


def test_value_type_decides(context):
    rate = LaunchConfiguration("rate")
    assert evaluated(context, ParameterValue(rate, value_type=str)) == "100"
    assert evaluated(context, ParameterValue(rate, value_type=float)) == 100.0
    values = ParameterValue(LaunchConfiguration("list"), value_type=list[float])
    assert evaluated(context, values) == [1.0, 2.5]
    assert evaluated(context, ParameterValue("[1, 2]", value_type=list[int])) == [1, 2]


def test_a_list_with_substitutions_is_one_text(context):
    assert evaluated(context, ["/", LaunchConfiguration("text")]) == "/3.x"


def test_integers_among_floats_become_floats(context):
    assert evaluated(context, [1, 2.5]) == [1.0, 2.5]


@pytest.mark.parametrize(
    ("value", "message"),
    [
        (object(), "cannot be a parameter"),
        (None, "cannot be a parameter"),
        (["a", 1], "mixes types"),
        ([[1]], "mixes types"),
        ([np.array([1.0])], "mixes types"),
        (ParameterValue("[2024-02-30]", value_type=list[str]), "is not YAML"),
        ([], "an empty list has no type"),
        ({}, "cannot be a parameter"),
        (ParameterValue("x", value_type=int), "'x' is not an integer"),
        (ParameterValue("x", value_type=bool), "neither true nor false"),
        (ParameterValue("x", value_type=dict), "value_type"),
        (ParameterValue("3", value_type=list[int]), "a list is needed, not 3"),
        (ParameterValue({}, value_type=str), "a text is needed, not"),
    ],
)
def test_a_value_that_cannot_be_a_parameter_is_reported(context, value, message):
    with pytest.raises(NodeParameterError, match=rf"parameter 'p': .*{message}"):
        evaluated(context, value)


def test_a_malformed_list_is_named(context):
    context.launch_configurations["bad"] = "[1, 2"
    with pytest.raises(NodeParameterError, match="is not YAML"):
        evaluated(context, LaunchConfiguration("bad"))


PRINT_PARAMETERS = """
import json, sys
import rclpy
from rclpy.node import Node
rclpy.init()
node = Node(
    "n", namespace="a", allow_undeclared_parameters=True,
    automatically_declare_parameters_from_overrides=True,
)
values = {name: p.value for name, p in node._parameters.items() if "start_type" not in name}
values = {n: list(v) if hasattr(v, "typecode") else v for n, v in values.items()}
print(json.dumps(values))
node.destroy_node()
rclpy.shutdown()
"""


@pytest.mark.ros
def test_a_real_node_reads_the_file(tmp_path, context):
    values = evaluate_parameters(
        context,
        {
            "flag": LaunchConfiguration("flag"),
            "count": 3,
            "rate": 100.0,
            "tiny": 1e-7,
            "endless": math.inf,
            "word": "yes",
            "number": "1.0",
            "description": ParameterValue(LaunchConfiguration("urdf"), value_type=str),
            "joints": ["j0", "j1"],
            "pose": [0.0, 1.5],
            "limits": {"j0": {"max": 2.0}},
        },
    )
    path = tmp_path / "params.yaml"
    path.write_text(parameter_file_text("/a/n", values), encoding="utf-8")
    done = run_python("-c", PRINT_PARAMETERS, "--ros-args", "--params-file", str(path))
    assert done.returncode == 0, done.stderr
    # Fast DDS may print errors first, about shared memory of other programs that were killed.
    read = json.loads(done.stdout.splitlines()[-1])
    assert values.pop("limits") == {"j0": {"max": read.pop("limits.j0.max")}}
    assert {name: read[name] for name in values} == values
    assert {name: type(read[name]) for name in values} == {n: type(v) for n, v in values.items()}


@pytest.mark.parametrize(
    ("text", "problem"),
    [
        ("[" * 65, "is nested more than 64 deep"),
        ("[&a [x, x], *a]", "has an alias (*), which a value cannot have"),
        ("[!!bool x]", "is not YAML: "),
        ('[!!int ""]', "is not YAML: "),
        ("[!!timestamp x]", "is not YAML: "),
    ],
)
def test_a_text_that_cannot_be_a_value_is_reported_briefly(text, problem):
    with pytest.raises(NodeParameterError) as caught:
        read_yaml(text)
    assert problem in str(caught.value)
    assert len(str(caught.value)) < 250
