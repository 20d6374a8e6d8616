"""Filling messages from YAML: valid, truncated and refused values."""

import pytest
from builtin_interfaces.msg import Time
from control_msgs.action import FollowJointTrajectory
from control_msgs.msg import DynamicJointState
from geometry_msgs.msg import PoseStamped
from sensor_msgs.msg import CameraInfo, Image, JointState
from std_msgs.msg import Bool, Byte, Float64, Float64MultiArray, Int64, String, UInt8
from trajectory_msgs.msg import JointTrajectory

from arm_node.messages import MessageValueError
from arm_node.messages.filling import fill_message, read_yaml, read_yaml_documents
from arm_node.messages.text import to_yaml


def filled(class_, text):
    return fill_message(class_(), read_yaml(text, class_.__name__))


def test_a_list_of_numbers():
    message = filled(Float64MultiArray, "data: [0.0, 1, -2.5]").message
    assert list(message.data) == [0.0, 1.0, -2.5]


def test_the_tutorial_s_trajectory_with_a_float_in_an_integer_field():
    result = filled(
        JointTrajectory,
        "{joint_names: [a, b], points: [{positions: [1.345, -1.23], "
        "time_from_start: {sec: 3.0, nanosec: 0}}]}",
    )
    assert result.message.points[0].time_from_start.sec == 3
    assert result.notes == []


def test_a_fraction_in_an_integer_field_is_truncated_with_a_note():
    result = filled(JointTrajectory, "points: [{time_from_start: {sec: 1.5}}]")
    assert result.message.points[0].time_from_start.sec == 1
    assert result.notes == ["points[0].time_from_start.sec: 1.5 is truncated to 1 (int32)"]


def test_a_whole_number_is_never_truncated():
    result = filled(Int64, f"data: {2**53 + 1}")
    assert (result.message.data, result.notes) == (2**53 + 1, [])


def test_a_goal_with_a_nested_message_of_another_package():
    goal = filled(FollowJointTrajectory.Goal, "trajectory: {joint_names: [j0]}").message
    assert goal.trajectory.joint_names == ["j0"]


def test_text_is_converted_to_the_field_s_type():
    assert filled(String, "data: hello").message.data == "hello"
    assert filled(String, "data: 5").message.data == "5"
    assert filled(Float64, "data: 1e-3").message.data == 0.001
    assert filled(Bool, "data: true").message.data is True
    assert filled(Byte, "data: 7").message.data == b"\x07"
    assert list(filled(Image, "data: [1, 255]").message.data) == [1, 255]
    assert filled(Int64, f"data: {2**63 - 1}").message.data == 2**63 - 1
    assert filled(CameraInfo, f"k: {list(range(9))}").message.k[8] == 8.0
    assert filled(DynamicJointState, "joint_names: [a]").message.joint_names == ["a"]


def test_auto_and_now_get_the_time_of_sending():
    result = filled(JointState, "{header: auto, name: [j0]}")
    result.stamp(Time(sec=7))
    assert result.message.header.stamp.sec == 7
    nested = filled(PoseStamped, "header: {stamp: now, frame_id: world}")
    nested.stamp(Time(sec=8))
    assert (nested.message.header.stamp.sec, nested.message.header.frame_id) == (8, "world")


@pytest.mark.parametrize(
    ("class_", "text", "sentence"),
    [
        (
            Float64MultiArray,
            "dta: [0]",
            "no field 'dta'; did you mean 'data'? (fields: layout, data)",
        ),
        (
            JointTrajectory,
            "points: [{time_from_start: {secs: 1}}]",
            "no field 'secs' in points[0].time_from_start; did you mean 'sec'? "
            "(fields: sec, nanosec)",
        ),
        (Float64MultiArray, "data: [0, x]", "data[1]: 'x' is not a number (float64)"),
        (Float64MultiArray, "data: 1.0", "data: 1.0 is not a list (float64[])"),
        (Float64, "data: [1.0]", "data: [1.0] is not a number (float64)"),
        (Float64, "data: true", "data: True is not a number (float64)"),
        (UInt8, "data: 300", "data: 300 does not fit uint8 (0 to 255)"),
        (UInt8, "data: .nan", "data: nan is not a whole number (uint8)"),
        (Bool, "data: maybe", "data: 'maybe' is neither true nor false (bool)"),
        (String, "data: {a: 1}", "data: {'a': 1} is not a text (string)"),
        (
            String,
            r'data: "a\ud800"',
            "the values are not YAML: line 1, column 11: found invalid Unicode character "
            "escape code",
        ),
        (
            Image,
            "data: \ud800",
            r"the values are not YAML: '\ud800' at character 7 is not valid UTF-8",
        ),
        (CameraInfo, "k: [1.0]", "k: 1 values, but float64[9] holds 9"),
        (
            JointState,
            "header: 5",
            "header: 5 where a message is expected (fields: stamp, frame_id)",
        ),
    ],
)
def test_a_value_that_does_not_fit_is_reported_with_its_field(class_, text, sentence):
    with pytest.raises(MessageValueError) as error:
        filled(class_, text)
    assert str(error.value) == sentence


@pytest.mark.parametrize(
    ("text", "part"),
    [
        ("data: [0.0", "are not YAML: line 2, column 1: "),
        ("data: 2001-13-45", "not fit its type: month must be in 1..12"),
        ("[1, 2]", "is it quoted for the shell?"),
    ],
)
def test_values_that_are_not_a_mapping_are_refused(text, part):
    with pytest.raises(MessageValueError, match="values") as error:
        read_yaml(text, "std_msgs/msg/Float64MultiArray")
    assert part in str(error.value)


def test_an_empty_text_has_no_values():
    assert read_yaml("", "std_msgs/msg/Empty") == {}


def test_each_document_that_echo_prints_is_a_message():
    text = "".join(to_yaml(String(data=word)) + "---\n" for word in ("a", "b"))
    documents = read_yaml_documents("---\n" + text + "---\n{}\n---\n", "std_msgs/msg/String")
    assert documents == [{"data": "a"}, {"data": "b"}, {}]


@pytest.mark.parametrize(
    ("text", "sentence"),
    [
        (
            "---\ndata: a\n---\n5\n",
            "message 2: the values of a std_msgs/msg/String are written 'field: value', "
            "but 5 is a int",
        ),
        (
            "data: a\n---\ndata: [b\n---\n",
            "the values are not YAML: line 4, column 1: did not find expected ',' or ']'",
        ),
        (
            "data: \x01",
            "the values are not YAML: unacceptable character #x0001: control characters are not "
            'allowed in "<unicode string>", position 6',
        ),
    ],
)
def test_a_file_that_does_not_hold_messages_is_reported(text, sentence):
    with pytest.raises(MessageValueError) as error:
        read_yaml_documents(text, "std_msgs/msg/String")
    assert str(error.value) == sentence
