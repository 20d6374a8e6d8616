"""From the type of a message to a form, and from what is typed back to a message."""

import math

import pytest
from builtin_interfaces.msg import Time
from control_msgs.action import FollowJointTrajectory
from controller_manager_msgs.srv import SwitchController
from geometry_msgs.msg import PoseStamped
from hypothesis import given, settings
from hypothesis import strategies as st
from rosidl_parser.definition import (
    AbstractGenericString,
    AbstractNestedType,
    Array,
    BasicType,
    NamespacedType,
)
from sensor_msgs.msg import JointState
from std_msgs.msg import Byte, Char, Empty, Float32, Int64, UInt64
from std_srvs.srv import SetBool

from arm_node.messages import MessageValueError
from arm_node.messages.fields import INTEGER_RANGES, message_class, slots, type_name
from arm_viewer.calls.form import MAX_FIELDS, FieldKind, form_of, read_form

TYPES = (PoseStamped, JointState, Byte, Char, Float32, UInt64, SwitchController.Request)
EXAMPLES = 15


@st.composite
def messages(draw, class_):
    """A message with any values that it can hold."""
    message = class_()
    for name, type_ in slots(message).items():
        setattr(message, name, draw(values(type_)))
    return message


def values(type_):
    if isinstance(type_, NamespacedType):
        return messages(message_class(type_))
    if isinstance(type_, AbstractNestedType):
        inner = values(type_.value_type)
        length = type_.size if isinstance(type_, Array) else None
        return st.lists(inner, min_size=length or 0, max_size=length or 2)
    if isinstance(type_, AbstractGenericString):
        # A message cannot hold a NUL, and a text with surrogates cannot be sent.
        return st.text(st.characters(exclude_categories=("Cs",), exclude_characters="\0"))
    assert isinstance(type_, BasicType)
    name = type_name(type_)
    if name == "bool":
        return st.booleans()
    if name.startswith("float"):
        return st.floats(width=int(name.removeprefix("float")), allow_nan=False)
    if name == "byte":
        return st.binary(min_size=1, max_size=1)
    return st.integers(*INTEGER_RANGES.get(name, (0, 255)))


def typed(fields):
    return {field.path: field.text for field in fields}


@pytest.mark.parametrize("class_", TYPES, ids=lambda c: c.__name__)
@settings(max_examples=EXAMPLES)
@given(data=st.data())
def test_a_form_that_nobody_touches_gives_back_its_message(class_, data):
    message = data.draw(messages(class_))
    fields = form_of(message)
    assert len(fields) <= MAX_FIELDS
    assert read_form(class_(), typed(fields)).message == message


def test_the_fields_of_nested_messages_have_a_line_each_and_a_time_has_one():
    kinds = {field.path: field.kind.value for field in form_of(PoseStamped())}
    assert kinds == {
        "header.stamp": "yaml",
        "header.frame_id": "text",
        **{f"pose.position.{axis}": "number" for axis in "xyz"},
        **{f"pose.orientation.{axis}": "number" for axis in "xyzw"},
    }


def test_arrays_are_yaml():
    fields = {field.path: field for field in form_of(FollowJointTrajectory.Goal())}
    points = fields["trajectory.points"]
    assert (points.kind, points.type) == (
        FieldKind.YAML,
        "trajectory_msgs/msg/JointTrajectoryPoint[]",
    )
    assert points.text == "[]"


def test_defaults_and_ranges_come_from_the_type():
    (field,) = form_of(Int64())
    assert (field.text, field.least, field.most) == ("0", -(2**63), 2**63 - 1)
    orientation = form_of(PoseStamped())[-1]
    assert orientation.text == "1.0"


def test_a_request_without_fields_has_an_empty_form():
    assert form_of(Empty()) == ()
    assert read_form(Empty(), {}).message == Empty()


def test_what_is_left_empty_keeps_its_value():
    pose = read_form(PoseStamped(), {"pose.position.x": "", "pose.orientation.w": ""}).message
    assert pose == PoseStamped()


def test_a_time_may_be_that_of_sending():
    filled = read_form(PoseStamped(), {"header.stamp": "now"})
    filled.stamp(Time(sec=7))
    assert filled.message.header.stamp.sec == 7


def test_numbers_of_64_bits_lose_nothing():
    assert read_form(Int64(), {"data": str(2**63 - 1)}).message.data == 2**63 - 1


@pytest.mark.parametrize("text", [".nan", "nan", "-.inf", "1e-3"])
def test_numbers_may_be_written_as_in_yaml_or_python(text):
    data = read_form(Float32(), {"data": text}).message.data
    assert math.isnan(data) or math.isinf(data) or data == pytest.approx(0.001)


@pytest.mark.parametrize(
    ("class_", "path", "text", "problem"),
    [
        (Float32, "data", "fast", "data: 'fast' is not a number (float32)"),
        (Int64, "data", str(2**63), "does not fit int64"),
        (JointState, "name", "a", "name: 'a' is not a list (string[])"),
        (JointState, "name", "[a", "name: line 2"),
        (JointState, "speed", "1", "no field 'speed' (fields: header.stamp"),
        (SetBool.Request, "data", "perhaps", "neither true nor false"),
        (JointState, "name", "&a [*a, *a]", "contains itself"),
        (PoseStamped, "pose", "{}", "no field 'pose'"),
    ],
)
def test_what_does_not_fit_is_refused_with_the_field(class_, path, text, problem):
    with pytest.raises(MessageValueError) as refused:
        read_form(class_(), {path: text})
    assert problem in str(refused.value)
