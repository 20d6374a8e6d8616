"""The type that a value has for a node, by how it is given; rcl itself is the judge."""

import math

import pytest

from launch_py import LaunchDescription
from launch_py.launch_description import expand_description
from launch_py.launch_description_sources import read_launch_file
from launch_py.ros import Node, ParameterFile
from launch_py.substitutions import LaunchConfiguration

pytestmark = pytest.mark.ros

TABLE = [
    # text, by a substitution, in a file or after -p
    ("1", 1, 1),
    ("-7", -7, -7),
    ("+2.5", 2.5, 2.5),
    ("1.0", 1.0, 1.0),
    (".5", 0.5, 0.5),
    ("5.", 5.0, 5.0),
    ("1e3", 1000.0, 1000.0),
    ("1.0e3", 1000.0, 1000.0),
    ("1e-400", "1e-400", "1e-400"),
    ("010", 8, 8),
    ("08", 8.0, 8.0),
    ("0x1F", 31, 31),
    ("0o17", "0o17", "0o17"),
    ("0b11", 3, "0b11"),
    ("1_000", 1000, "1_000"),
    ("1:30", 90, "1:30"),
    ("99999999999999999999", 1e20, 1e20),
    ("nan", math.nan, math.nan),
    (".nan", math.nan, math.nan),
    ("inf", math.inf, math.inf),
    ("-.inf", -math.inf, -math.inf),
    ("infinity", math.inf, math.inf),
    ("true", True, True),
    ("FALSE", False, False),
    ("tRUE", "tRUE", "tRUE"),
    ("yes", True, True),
    ("Off", False, False),
    ("y", True, True),
    ("N", False, False),
    ("null", "", "null"),
    ("~", "", "~"),
    ("arm", "arm", "arm"),
    ("1.2.3", "1.2.3", "1.2.3"),
    ("2024-01-01", "2024-01-01", "2024-01-01"),
    ("192.168.0.1:80", "192.168.0.1:80", "192.168.0.1:80"),
    ("a/b.urdf", "a/b.urdf", "a/b.urdf"),
    ("'5'", "5", "5"),
    ('"true"', "true", "true"),
    ("[1, 2]", [1, 2], [1, 2]),
    ("[1e3, 2e3]", [1000.0, 2000.0], [1000.0, 2000.0]),
    ("[1.5, 2.0]", [1.5, 2.0], [1.5, 2.0]),
    ("[yes, off]", [True, False], [True, False]),
    ("[a, 'b']", ["a", "b"], ["a", "b"]),
    ("['1', '2']", ["1", "2"], ["1", "2"]),
    ("[nan, inf]", [math.nan, math.inf], [math.nan, math.inf]),
]


def is_same(value, expected):
    if isinstance(expected, list):
        return len(value) == len(expected) and all(map(is_same, value, expected))
    if isinstance(expected, float) and math.isnan(expected):
        return isinstance(value, float) and math.isnan(value)
    return type(value) is type(expected) and value == expected


@pytest.fixture(scope="module")
def read(tmp_path_factory, read_by_nodes, ros_arguments):
    """What nodes read of each text of the table, by how it is given."""
    folder = tmp_path_factory.mktemp("types")
    (folder / "share/ament_index/resource_index/packages").mkdir(parents=True)
    (folder / "share/ament_index/resource_index/packages/demo").touch()
    (folder / "lib/demo").mkdir(parents=True)
    (folder / "lib/demo/talker").touch(mode=0o755)
    environ = {"AMENT_PREFIX_PATH": str(folder)}
    names = {f"v{number}": text for number, (text, *_) in enumerate(TABLE)}
    file = folder / "file.yaml"
    template = folder / "template.yaml"
    for path, values in (file, names.values()), (template, (f"$(var {name})" for name in names)):
        lines = (f"    {name}: {value}\n" for name, value in zip(names, values, strict=True))
        path.write_text(f"/**:\n  ros__parameters:\n{''.join(lines)}", encoding="utf-8")
    xml = folder / "a.launch.xml"
    children = "".join(f'<param name="{name}" value="$(var {name})"/>' for name in names)
    xml.write_text(f'<launch><node pkg="demo" exec="talker" name="n">{children}</node></launch>')

    def arguments(kind, description):
        plan = expand_description(description, names, environ)
        return ros_arguments(plan, folder / kind)

    def of_node(kind, parameters):
        node = Node(executable="/bin/true", name="n", parameters=[parameters])
        return arguments(kind, LaunchDescription([node]))

    ways = {
        "substitution": of_node("a", {name: LaunchConfiguration(name) for name in names}),
        "xml": arguments("b", read_launch_file(xml)),
        "dict": of_node("c", names),
        "template": of_node("d", ParameterFile(template, allow_substs=True)),
        "file": ["--params-file", str(file)],
        "-p": [word for name, text in names.items() for word in ("-p", f"{name}:={text}")],
    }
    return dict(zip(ways, read_by_nodes(list(ways.values())), strict=True))


@pytest.mark.parametrize(("number", "row"), list(enumerate(TABLE)), ids=[row[0] for row in TABLE])
def test_a_value_has_the_type_that_it_has_in_ros(read, number, row):
    text, substituted, plain = row
    expected = {
        "substitution": substituted,
        "xml": substituted,
        "file": plain,
        "template": plain,
        "-p": plain,
        "dict": text,  # A text of a Python launch file stays a text.
    }
    wrong = {
        way: read[way][f"v{number}"]
        for way, value in expected.items()
        if not is_same(read[way][f"v{number}"], value)
    }
    assert not wrong
