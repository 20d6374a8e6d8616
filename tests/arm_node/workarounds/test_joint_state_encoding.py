"""JointState read from its bytes, against what rclpy writes."""

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from arm_node.workarounds import joint_state_encoding
from arm_node.workarounds.joint_state_encoding import (
    EncodingError,
    read_joint_positions,
    read_joint_state,
)

NAMES = st.lists(st.text(st.characters(codec="utf-8", exclude_characters="\0"), max_size=9))
NUMBERS = st.lists(st.floats(allow_nan=False), max_size=9)


def serialized(names=(), positions=(), frame="", sec=0, nanosec=0, efforts=()) -> bytes:
    from rclpy.serialization import serialize_message
    from sensor_msgs.msg import JointState

    message = JointState(name=list(names), position=list(positions), effort=list(efforts))
    message.header.frame_id = frame
    message.header.stamp.sec = sec
    message.header.stamp.nanosec = nanosec
    return serialize_message(message)


@pytest.mark.ros
@settings(deadline=None)
@given(NAMES, NUMBERS, st.text(st.characters(codec="ascii", exclude_characters="\0")), NUMBERS)
def test_what_rclpy_writes_is_read(names, positions, frame, efforts):
    read = read_joint_positions(serialized(names, positions, frame, 12, 345, efforts))
    assert read.names == tuple(names)
    assert read.positions.tolist() == positions
    assert read.stamp_ns == 12_000_000_345


@pytest.mark.ros
def test_a_stamp_before_the_epoch():
    assert read_joint_positions(serialized(sec=-2, nanosec=5)).stamp_ns == -1_999_999_995


@pytest.mark.ros
def test_values_that_are_not_numbers_are_passed_on():
    assert np.isnan(read_joint_positions(serialized(["a"], [float("nan")])).positions[0])


WHOLE = (
    b"\x00\x01\x00\x00"  # little-endian CDR
    b"\x01\x00\x00\x00\x02\x00\x00\x00"  # stamp
    b"\x02\x00\x00\x00f\x00??"  # frame_id, and padding
    b"\x01\x00\x00\x00\x06\x00\x00\x00joint\x00??"  # one name, and padding
    b"\x01\x00\x00\x00????"  # one position, and padding
    b"\x00\x00\x00\x00\x00\x00\xe0\x3f"
    b"\x00\x00\x00\x00\x00\x00\x00\x00"  # no velocities, no efforts
)


def test_the_layout_by_hand():
    read = read_joint_positions(WHOLE)
    assert read.names == ("joint",)
    assert read.positions.tolist() == [0.5]
    assert read.stamp_ns == 1_000_000_002


@pytest.mark.parametrize("length", range(len(WHOLE) - 8))
def test_bytes_that_end_too_early_are_refused(length):
    with pytest.raises(EncodingError):
        read_joint_positions(WHOLE[:length])


def test_another_encoding_is_refused():
    with pytest.raises(EncodingError, match="CDR"):
        read_joint_positions(b"\x00\x00" + WHOLE[2:])


@pytest.mark.parametrize("at", [12, 20, 24, 36])
def test_a_count_beyond_all_bounds_is_refused(at):
    with pytest.raises(EncodingError):
        read_joint_positions(WHOLE[:at] + b"\xff\xff\xff\xff" + WHOLE[at + 4 :])


@settings(deadline=None)
@given(st.binary(max_size=64))
def test_any_bytes_are_read_or_refused(data):
    try:
        read = read_joint_positions(b"\x00\x01" + data)
    except EncodingError:
        return
    assert len(read.positions) * 8 <= len(data)


@pytest.mark.ros
@pytest.mark.parametrize("is_on", [True, False])
def test_the_workaround_reads_what_rclpy_reads(monkeypatch, is_on):
    monkeypatch.setattr(joint_state_encoding, "is_on", lambda _name: is_on)
    read = read_joint_state(serialized(["a", "è"], [0.5, -1.0], "frame", -2, 5, [3.0]))
    assert (read.names, read.positions.tolist()) == (("a", "è"), [0.5, -1.0])
    assert read.stamp_ns == -1_999_999_995
    with pytest.raises(EncodingError):
        read_joint_state(serialized(["a"], [0.5])[:20])
    with pytest.raises(EncodingError):
        read_joint_state(b"\x07\x07" + WHOLE[2:])
