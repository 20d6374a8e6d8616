"""Messages whose numbers are written in place, against rclpy's own serialisation."""

from types import SimpleNamespace
from typing import Any

import numpy as np
import pytest
from builtin_interfaces.msg import Duration
from control_msgs.msg import DynamicJointState, InterfaceValue
from geometry_msgs.msg import PoseWithCovariance, TransformStamped
from rclpy.serialization import deserialize_message
from rosgraph_msgs.msg import Clock
from sensor_msgs.msg import BatteryState, CameraInfo, JointState
from std_msgs.msg import Float64MultiArray, String
from tf2_msgs.msg import TFMessage
from trajectory_msgs.msg import JointTrajectory, JointTrajectoryPoint

from arm_node.workarounds import message_template
from arm_node.workarounds.cdr_layout import HEADER_BYTES, LITTLE_ENDIAN, CdrLayout
from arm_node.workarounds.message_fields import MessageLayoutError
from arm_node.workarounds.message_template import MessageTemplate

STAMP_NS = 1_234_567_890_123_456_789

pytestmark = pytest.mark.ros


def written(template: MessageTemplate, kind: type) -> Any:
    """Return the message that a subscriber would get."""
    return deserialize_message(template.to_bytes(), kind)


def joint_state(names: list[str], frame: str = "") -> JointState:
    zeros = [0.0] * len(names)
    message = JointState(name=names, position=zeros, velocity=zeros, effort=zeros)
    message.header.frame_id = frame
    return message


@pytest.mark.parametrize("frame", ["", "a", "ab", "abc", "abcd", "base_link"])
@pytest.mark.parametrize("names", [[], ["j"], ["j0", "joint_1", "è"]])
def test_a_joint_state_with_strings_of_any_length(frame, names):
    template = MessageTemplate(joint_state(names, frame))
    expected = joint_state(names, frame)
    expected.header.stamp.sec, expected.header.stamp.nanosec = 1_234_567_890, 123_456_789
    for field, first in (("position", 0.5), ("velocity", -1.0), ("effort", 1e300)):
        values = [first + n for n in range(len(names))]
        setattr(expected, field, values)
        template.doubles(field)[:] = values
    template.set_stamps(STAMP_NS)
    assert written(template, JointState) == expected


def test_the_views_may_be_written_again_and_again():
    template = MessageTemplate(joint_state(["a", "b"]))
    position = template.doubles("position")
    for value in (1.0, float("nan"), -0.0, 2.0):
        position[:] = value
    assert list(written(template, JointState).position) == [2.0, 2.0]


def test_what_is_written_does_not_reach_the_prototype_and_the_reverse():
    prototype = joint_state(["a"])
    template = MessageTemplate(prototype)
    template.doubles("position")[:] = 1.0
    prototype.effort = [5.0]
    assert list(prototype.position) == [0.0]
    assert list(written(template, JointState).effort) == [0.0]


def test_values_of_the_prototype_stay_until_they_are_written():
    prototype = JointState(name=["a"], position=[3.0])
    prototype.header.stamp.sec = 7
    template = MessageTemplate(prototype)
    template.doubles("position")
    assert written(template, JointState) == prototype


def test_bytes_handed_out_do_not_change_with_the_template():
    template = MessageTemplate(joint_state(["a"]))
    before = template.to_bytes()
    copy = bytes(before)
    template.doubles("position")[:] = 1.0
    assert before == copy


def test_a_clock():
    template = MessageTemplate(Clock())
    template.set_stamps(STAMP_NS)
    clock = written(template, Clock).clock
    assert (clock.sec, clock.nanosec) == (1_234_567_890, 123_456_789)


def test_a_time_before_the_epoch():
    template = MessageTemplate(Clock())
    template.set_stamps(-1)
    clock = written(template, Clock).clock
    assert (clock.sec, clock.nanosec) == (-1, 999_999_999)


def test_a_time_that_the_message_cannot_hold_is_refused():
    with pytest.raises(OverflowError):
        MessageTemplate(Clock()).set_stamps(2**31 * 10**9)


def test_dynamic_joint_states_in_one_go():
    prototype = DynamicJointState(
        joint_names=["a", "b"],
        interface_values=[
            InterfaceValue(interface_names=["position", "v"], values=[0.0, 0.0]),
            InterfaceValue(interface_names=["effort"], values=[0.0]),
        ],
    )
    prototype.header.frame_id = "base"
    template = MessageTemplate(prototype)
    where = template.indices("interface_values[*].values")
    template.float64[where] = [1.0, 2.0, 3.0]
    template.set_stamps(STAMP_NS)
    message = written(template, DynamicJointState)
    assert [list(v.values) for v in message.interface_values] == [[1.0, 2.0], [3.0]]
    assert [v.interface_names for v in message.interface_values] == [["position", "v"], ["effort"]]
    assert message.header.stamp.sec == 1_234_567_890


def tf_message(count: int) -> TFMessage:
    message = TFMessage()
    for n in range(count):
        stamped = TransformStamped(child_frame_id="c" * n)
        stamped.header.frame_id = "p" * (n % 3)
        message.transforms.append(stamped)
    return message


@pytest.mark.parametrize("count", [0, 1, 12])
def test_transforms_have_one_stamp_and_numbers_of_their_own(count):
    template = MessageTemplate(tf_message(count))
    values = np.arange(7.0 * count)
    template.float64[template.indices("transforms[*].transform")] = values
    template.set_stamps(STAMP_NS)
    message = written(template, TFMessage)
    expected = tf_message(count)
    for stamped, row in zip(expected.transforms, values.reshape(-1, 7).tolist(), strict=True):
        stamped.header.stamp.sec, stamped.header.stamp.nanosec = 1_234_567_890, 123_456_789
        translation, rotation = stamped.transform.translation, stamped.transform.rotation
        translation.x, translation.y, translation.z = row[:3]
        rotation.x, rotation.y, rotation.z, rotation.w = row[3:]
    assert message == expected


def test_one_of_several_messages():
    template = MessageTemplate(tf_message(3))
    template.doubles("transforms[1].transform.translation")[:] = [1.0, 2.0, 3.0]
    message = written(template, TFMessage)
    assert [t.transform.translation.y for t in message.transforms] == [0.0, 2.0, 0.0]


def test_arrays_of_fixed_length_and_single_numbers():
    template = MessageTemplate(CameraInfo(d=[0.0, 0.0]))
    template.doubles("k")[:] = np.arange(9.0)
    template.doubles("d")[:] = [5.0, 6.0]
    message = written(template, CameraInfo)
    assert message.k.tolist() == list(np.arange(9.0))
    assert list(message.d) == [5.0, 6.0]
    pose = MessageTemplate(PoseWithCovariance())
    pose.doubles("pose.position.z")[:] = 4.0
    pose.doubles("covariance")[:] = 2.0
    message = written(pose, PoseWithCovariance)
    assert message.pose.position.z == 4.0
    assert message.covariance.tolist() == [2.0] * 36


def test_a_message_without_stamps_has_none_to_set():
    template = MessageTemplate(Float64MultiArray(data=[1.0, 2.0]))
    template.set_stamps(STAMP_NS)
    template.doubles("data")[1] = 7.0
    assert list(written(template, Float64MultiArray).data) == [1.0, 7.0]


def test_a_duration_is_not_a_stamp():
    point = JointTrajectoryPoint(positions=[0.0], time_from_start=Duration(sec=3))
    template = MessageTemplate(point)
    template.set_stamps(STAMP_NS)
    assert written(template, JointTrajectoryPoint) == point


def test_durations_and_times_are_found_by_their_path():
    prototype = JointTrajectory(
        joint_names=["a"], points=[JointTrajectoryPoint(positions=[0.0]) for _ in range(2)]
    )
    template = MessageTemplate(prototype)
    template.int32[template.time_indices("points[1].time_from_start")] = (-1, 750_000_000)
    template.int32[template.time_indices("header.stamp")] = (3, 4)
    message = written(template, JointTrajectory)
    first, second = (point.time_from_start for point in message.points)
    assert (first.sec, first.nanosec) == (0, 0)
    assert (second.sec, second.nanosec) == (-1, 750_000_000)
    assert (message.header.stamp.sec, message.header.stamp.nanosec) == (3, 4)


def test_a_path_that_leads_to_no_time_is_refused():
    with pytest.raises(MessageLayoutError, match="'header' is Header, neither time nor duration"):
        MessageTemplate(joint_state(["a"])).time_indices("header")


def test_a_message_that_is_only_text():
    assert written(MessageTemplate(String(data="abc")), String).data == "abc"


@pytest.mark.parametrize(
    ("prototype", "path", "message"),
    [
        (JointState(), "positions", r"JointState has no field 'positions'; it has header, name, "),
        (JointState(), "header.x", "Header has no field 'x'; it has stamp, frame_id"),
        (JointState(), "name", "'name' of JointState is not a message"),
        (JointState(), "name.x", "'name' of JointState is not a message"),
        (JointState(), "header", "'sec' of Time is not a message"),
        (JointState(), "", "JointState has no field ''"),
        (BatteryState(), "voltage", "'voltage' of BatteryState is not a message"),
        (TFMessage(), "transforms", r"a sequence takes \[\*\] or an index"),
        (tf_message(1), "transforms[*].header[*].x", r"a sequence takes \[\*\] or an index"),
        (tf_message(1), "transforms[1].transform", "the sequence has length 1"),
        (tf_message(1), "transforms[x].transform", r"no field 'transforms\[x\]'"),
    ],
)
def test_a_path_that_leads_to_no_numbers_is_refused(prototype, path, message):
    with pytest.raises(MessageLayoutError, match=message):
        MessageTemplate(prototype).indices(path)


@pytest.mark.workaround("message_template")
def test_values_in_several_places_have_no_view():
    with pytest.raises(MessageLayoutError, match="not contiguous"):
        MessageTemplate(tf_message(2)).doubles("transforms[*].transform")


@pytest.fixture(params=["off by hand", "another encoding", "numbers elsewhere"])
def without_the_workaround(request, monkeypatch):
    """Messages are laid out by rclpy, for one of two reasons."""
    if request.param == "off by hand":
        monkeypatch.setattr(message_template, "is_on", lambda _name: False)
    elif request.param == "numbers elsewhere":
        monkeypatch.setattr(message_template, "CdrLayout", ShiftedLayout)
    else:
        serialize = message_template.serialize_message
        monkeypatch.setattr(
            message_template, "serialize_message", lambda message: scrambled(serialize(message))
        )
        monkeypatch.setattr(
            message_template, "deserialize_message", lambda data, kind: read_scrambled(data, kind)
        )


class ShiftedLayout(CdrLayout):
    """Says that each field begins where the field before it does."""

    def __init__(self, message: Any) -> None:
        super().__init__(message)
        before = [HEADER_BYTES, *self.begins.values()]
        self.begins = dict(zip(self.begins, before, strict=False))


def scrambled(data: bytes) -> bytes:
    """Move every number by one byte, as an encoding without alignment would, and say so."""
    return b"\0\x99" + data[2:HEADER_BYTES] + b"\0" + data[HEADER_BYTES:]


def read_scrambled(data: bytes, kind: type) -> Any:
    plain = LITTLE_ENDIAN + data[2:HEADER_BYTES] + data[HEADER_BYTES + 1 :]
    return deserialize_message(plain, kind)


def test_without_the_workaround_rclpy_serialises_the_same(without_the_workaround):
    expected = tf_message(2)
    template = MessageTemplate(expected)
    for number, stamped in enumerate(expected.transforms):
        stamped.transform.translation.x, stamped.transform.rotation.w = number + 0.5, -1.0
        stamped.header.stamp.sec, stamped.header.stamp.nanosec = 1_234_567_890, 123_456_789
        of_one = template.indices(f"transforms[{number}].transform")
        template.float64[of_one] = [number + 0.5, 0.0, 0.0, 0.0, 0.0, 0.0, -1.0]
    template.set_stamps(STAMP_NS)
    sent: list[Any] = []
    template.publish(SimpleNamespace(publish=sent.append))
    assert sent == [expected]


def test_without_the_workaround_a_sequence_has_a_view_and_a_time_has_its_words(
    without_the_workaround,
):
    point = JointTrajectoryPoint(time_from_start=Duration(sec=-1, nanosec=7), positions=[1.0, 2.0])
    template = MessageTemplate(JointTrajectory(points=[point]))
    template.doubles("points[0].positions")[1] = 5.0
    template.int32[template.time_indices("points[0].time_from_start")] = [3, 4]
    sent: list[Any] = []
    template.publish(SimpleNamespace(publish=sent.append))
    (read,) = sent[0].points
    assert list(read.positions) == [1.0, 5.0]
    assert read.time_from_start == Duration(sec=3, nanosec=4)
