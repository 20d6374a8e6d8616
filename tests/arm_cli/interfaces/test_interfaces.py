"""The installed types, and the verbs of `arm interface`, which need no ROS."""

import json

import pytest

from arm_cli.errors import NoSuchNameError
from arm_cli.interface_types import InterfaceIndex, load_class, nested_type, without_comment
from arm_cli.main import main


def printed(capsys, *words):
    assert main(["interface", *words]) == 0
    return capsys.readouterr().out


def test_show_prints_the_definition_with_nested_types_indented(capsys):
    lines = printed(capsys, "show", "std_msgs/msg/Float64MultiArray").splitlines()
    assert "MultiArrayLayout  layout        # specification of data layout" in lines
    assert "\tMultiArrayDimension[] dim" in lines
    assert "\t\tstring label" in lines
    assert "float64[]         data          # array of data" in lines
    assert not any(line.startswith("\t#") for line in lines)


def test_show_without_comments(capsys):
    assert printed(capsys, "show", "geometry_msgs/msg/Point", "--no-comments") == (
        "float64 x\nfloat64 y\nfloat64 z\n"
    )


def test_show_of_a_service_and_of_an_action(capsys):
    service = printed(capsys, "show", "std_srvs/srv/SetBool", "--no-comments")
    assert service == "bool data\n---\nbool success\nstring message\n"
    action = printed(capsys, "show", "control_msgs/action/GripperCommand", "--no-comments")
    assert action.startswith(
        "GripperCommand command\n\tfloat64 position\n\tfloat64 max_effort\n---"
    )


def test_show_takes_a_name_from_stdin(capsys, monkeypatch):
    import io

    monkeypatch.setattr("sys.stdin", io.StringIO("std_msgs/msg/Bool\n"))
    assert "bool data" in printed(capsys, "show", "-")


def test_list_names_the_types_by_kind(capsys):
    text = printed(capsys, "list", "--only-msgs")
    assert text.startswith("Messages:\n")
    assert "    sensor_msgs/msg/Image\n" in text
    assert "Services:" not in text
    assert "\nActions:\n" in printed(capsys, "list")


def test_package_and_packages(capsys):
    types = printed(capsys, "package", "control_msgs", "--only-actions").split()
    assert "control_msgs/action/FollowJointTrajectory" in types
    packages = json.loads(printed(capsys, "packages", "--json"))
    assert {"std_msgs", "control_msgs", "tf2_msgs"} <= set(packages)


def test_proto_prints_yaml_to_fill_in(capsys):
    assert printed(capsys, "proto", "std_msgs/msg/String") == "\"data: ''\n\"\n"
    goal = printed(capsys, "proto", "control_msgs/action/GripperCommand", "--no-quotes")
    assert goal == "command:\n  position: 0.0\n  max_effort: 0.0\n\n"


@pytest.mark.parametrize(
    ("name", "kinds", "sentence"),
    [
        (
            "std_msgs/msg/Float64MultArray",
            ("msg",),
            "did you mean 'std_msgs/msg/Float64MultiArray'",
        ),
        ("std_msg/msg/String", ("msg",), "no package 'std_msg'; did you mean 'std_msgs'"),
        ("std_srvs/srv/Trigger", ("msg",), "no message type 'std_srvs/srv/Trigger'"),
        ("String", ("msg", "srv", "action"), "no interface type 'String'"),
    ],
)
def test_an_unknown_type_suggests_similar_names(name, kinds, sentence):
    with pytest.raises(NoSuchNameError) as error:
        InterfaceIndex().find(name, kinds)
    assert sentence in str(error.value)


def test_a_short_name_means_the_full_name():
    type_ = InterfaceIndex().find("std_msgs/String", ("msg",))
    assert type_.full_name == "std_msgs/msg/String"
    assert load_class(type_).__name__ == "String"


@pytest.mark.parametrize(
    ("line", "type_"),
    [
        ("geometry_msgs/Point[] points", "geometry_msgs/msg/Point"),
        ("geometry_msgs/msg/Point p", "geometry_msgs/msg/Point"),
        ("Header header", "mine/msg/Header"),
        ("float64[<=3] x # Point p", None),
        ("string<=10 name 'Point'", None),
        ("uint8 LEFT=1", None),
        ("# Point p", None),
        ("---", None),
    ],
)
def test_the_nested_type_of_a_line(line, type_):
    assert nested_type(line, "mine") == type_


def test_a_comment_ends_a_line_unless_quoted():
    assert without_comment("string a '#1' # one") == "string a '#1'"
    assert without_comment("float64 x") == "float64 x"
