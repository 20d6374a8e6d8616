"""The reader of parameter files reads what rcl reads; rcl's own parser is the judge."""

from collections.abc import Callable, Iterator
from typing import Any

import pytest
import rclpy
from rclpy.context import Context
from rclpy.node import Node
from rclpy.parameter import Parameter

from arm_node.limited_yaml import YamlError
from arm_node.parameter_file import (
    applies,
    given_parameters,
    nested_parameters,
    parameters_by_node,
    parameters_text,
    read_parameters,
)

pytestmark = pytest.mark.ros

ReadByRcl = Callable[..., dict[str, Any]]
EVERY = "/**:\n  ros__parameters:\n"


@pytest.fixture(scope="module")
def context() -> Iterator[Context]:
    context = Context()
    rclpy.init(args=[], context=context)
    yield context
    rclpy.shutdown(context=context)


@pytest.fixture
def by_rcl(context, tmp_path) -> ReadByRcl:
    """Return the parameters of a node that starts with a file."""

    def read(text: str, node: str = "/n") -> dict[str, Any]:
        path = tmp_path / "params.yaml"
        path.write_text(text, encoding="utf-8")
        namespace, _, name = node.rpartition("/")
        made = Node(
            name,
            namespace=namespace or "/",
            context=context,
            use_global_arguments=False,
            enable_rosout=False,
            start_parameter_services=False,
            cli_args=["--ros-args", "--params-file", str(path)],
        )
        overrides: dict[str, Parameter] = made._parameter_overrides  # pyright: ignore[reportPrivateUsage]
        made.destroy_node()
        return {name: _plain(p.value) for name, p in overrides.items()}

    return read


def _plain(value: Any) -> Any:
    return list(value) if hasattr(value, "typecode") else value


def same(left: Any, right: Any) -> bool:
    """Return whether two values are equal in type and value, NaN included."""
    return repr(left) == repr(right)


TEXTS = """
1 -7 +1 010 -010 08 00 0 -0 0x1F 0X1f +0x10 0xg 0o17 0b11 1_000 1:30 1e3 1E-5 1e+5 1e 1. .5 -.5 +2.5
08. 5.0f 0x1p3 0x.8 0x1.8P1 0x1p2000 0x0p1 9223372036854775807 9223372036854775808
-9223372036854775808 99999999999999999999 1e308 1e400 1e-400 0e-400 0.0 -0.0 1e-310
2.2250738585072014e-308 nan NaN .nan .NAN -nan +nan -.nan +.nan nan(1) .nan(1) nanx inf -inf +INF
.inf -.Inf +.inf .infinity Infinity infx y Y n N yes Yes YES yES no on On ON oN off true True TRUE
tRue false t f null Null ~ 2024-01-01 1.2.3 arm a/b 192.168.0.1 '5' "08" 'y' !!str&5 !!int&5
!!float&5 [1,2] [1e3,2e3] [nan,1.0] [y,no] [a,'b'] ['1','2'] [!!str&5]
"""
PATTERNS = """
n /n ns/n /ns/n /** ** /**/n **/n /* * /*/n */n /*/*/n /ns/** /ns/* /ns/*/n /**/ns/n /**/* /*/**
/**/ns/**
"""


@pytest.mark.parametrize("text", [text.replace("&", " ") for text in TEXTS.split()])
def test_a_value_has_the_type_and_value_of_rcl(by_rcl, text):
    content = f"{EVERY}    a: {text}\n"
    [value] = given_parameters(read_parameters(content), "/n").values()
    assert same(value, by_rcl(content)["a"])


def test_a_block_of_text_is_read_as_by_rcl(by_rcl):
    content = f"{EVERY}    a: |\n      5\n    b: |-\n      5\n    c: >-\n      true\n    d: ''\n"
    assert same(given_parameters(read_parameters(content), "/n"), by_rcl(content))


REPEATED = [
    "/**: {ros__parameters: {a: 1, c: {d: 1}}}\n/**: {ros__parameters: {b: 2, c: {e: 2}}}",
    "n: {ros__parameters: {a: 1}}\nn: {ros__parameters: {b: 2}}",
    "/**: {n: {ros__parameters: {a: 1}}}\n/**: {n: {ros__parameters: {b: 2}}}",
    "/**: {ros__parameters: {a: 1, a: 2}}",
    "/**: {ros__parameters: {a: {b: 1}, a: {c: 2}}}",
    "/**: {ros__parameters: {a: {b: 1}, a: {b: 2}, a.b: 3}}",
    "/**: {ros__parameters: {a: {b: 1}, a.b: 2.5, c.d: 1, c: {d: 2.5}, e: {f: 1, f: 2.5}}}",
    "/**: {ros__parameters: {a: {b: 1}}}\n/**: {ros__parameters: {a: {b: 2.5}}}",
    "/**: {ros__parameters: {a: 1, a: 2.5, b: 2.5, b: 1, c: x, c: true, d: 1, d: x}}",
    "/**: {ros__parameters: {a: [1, 2], a: [3], b: [1], b: 5, c: [x], c: [1.0], d: 5, d: [1]}}",
    "/**: {ros__parameters: {a: 1}}\nn: {ros__parameters: {a: 2}}\n/n: {ros__parameters: {a: 3}}",
    "n: {ros__parameters: {a: 1}}\n/**: {ros__parameters: {a: 2}}",
    "/n: {ros__parameters: {a: 1}}\n/**: {ros__parameters: {a: 2}}\n/n: {ros__parameters: {a: 3}}",
    "/**/n: {ros__parameters: {a: 1}}\n/*: {ros__parameters: {a: 2}}",
    "/**: {ros__parameters: {a: 1}}\n---\n/**: {ros__parameters: {b: 1}}",
    "/**: {ros__parameters: {a: {b: 1}, a: 2}}",
    "/**: {ros__parameters: {a.b: {c.d: 1}, 1: 5, true: 6}}",
    "/**: {ros__parameters: {}}\nn: {}",
    "/**: {ros__parameters: {a: {ros__parameters: 1}}}",
    "5",
    "",
]


@pytest.mark.parametrize("content", REPEATED)
def test_repeated_keys_are_merged_as_by_rcl(by_rcl, content):
    read = given_parameters(read_parameters(content), "/n")
    expected = by_rcl(content)
    assert same(dict(sorted(read.items())), dict(sorted(expected.items())))


@pytest.mark.parametrize("node", ["/n", "/ns/n", "/ns/m/n", "/ns/k"])
@pytest.mark.parametrize("pattern", PATTERNS.split())
def test_names_mean_the_nodes_that_they_mean_to_rcl(by_rcl, pattern, node):
    content = f'"{pattern}": {{ros__parameters: {{a: 1}}}}'
    assert applies(pattern, node) is ("a" in by_rcl(content, node))


def test_namespaces_may_be_keys_above_the_nodes(by_rcl):
    content = "ns: {n: {ros__parameters: {a: 1}}, m: {n: {ros__parameters: {b: 1}}}}"
    read = read_parameters(content)
    assert list(read) == ["/ns/n", "/ns/m/n"]
    for node in "/ns/n", "/ns/m/n":
        assert given_parameters(read, node) == by_rcl(content, node)


def test_a_written_file_keeps_its_types(by_rcl):
    texts = "y", "08", "1e3", "nan", "0x1F", "5", "", "a b"
    values: dict[str, Any] = {f"t{number}": text for number, text in enumerate(texts)}
    values |= {"list": ["1e3", "y"], "f": 1e-7, "g": 1e300, "i": 3, "b": True, "l": [1.0, 2.5]}
    content = parameters_text({"/n": {"ros__parameters": {"group": values}}})
    expected = {f"group.{name}": value for name, value in values.items()}
    assert by_rcl(content) == expected
    assert given_parameters(read_parameters(content), "/n") == expected


def test_content_of_a_program_is_merged_too():
    content = {"ns": {"n": {"ros__parameters": {"a.b": 1, "a": {"c": 2}}}}, "k": {"x": {}}, "e": {}}
    assert parameters_by_node(content) == {
        "/ns/n": {"ros__parameters": {"a": {"b": 1, "c": 2}}},
        "/k/x": {},
        "k": {},
        "e": {},
    }
    assert parameters_by_node(parameters_by_node(content)) == parameters_by_node(content)


def test_a_name_that_is_a_value_and_a_group_keeps_its_dot():
    values = {"x.a.b": 2, "x.a": 1, "c.d": 4, "c": 3}
    assert nested_parameters(values) == {"x": {"a.b": 2, "a": 1}, "c.d": 4, "c": 3}


@pytest.mark.parametrize("text", ["? [1]\n: 2", "a: {<<: {b: 1}}", "a: ["])
def test_what_is_no_parameter_file_is_refused(text):
    with pytest.raises(YamlError):
        read_parameters(text)
