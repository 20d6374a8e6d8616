"""Reads a sensor_msgs/JointState directly from its bytes.

A joint state that the throttle drops costs rclpy as much as one that is used, because rclpy creates
Python objects for every field; that takes four times as long as reading only the needed fields:
https://github.com/ros2/rclpy/issues/836. Made for rclpy 7.1 and 9.1, whose subscriptions can return
bytes. If it is switched off, and for bytes of another encoding, rclpy deserialises the message.

The encoding is CDR (OMG DDS-RTPS 9.4.2.12): numbers are aligned to their size, counted from the end
of the four-byte header; strings and sequences are preceded by their length.
"""

import struct

import numpy as np
from numpy.typing import NDArray

from arm_node.frozen import frozen
from arm_node.workarounds.switch import is_on

NANOSECONDS = 1_000_000_000

_LITTLE_ENDIAN_CDR = b"\x00\x01"
_HEADER_BYTES = 4
_STAMP_AND_FRAME = struct.Struct("<iII")
_COUNT = struct.Struct("<I")


class EncodingError(ValueError):
    """The bytes are not a JointState in little-endian CDR."""


@frozen
class JointPositions:
    """The fields that the transforms depend on: positions (n,) in rad or m of the joints `names`.

    `positions` and `names` may differ in length if the sender made a mistake.
    """

    names: tuple[str, ...]
    positions: NDArray[np.float64]
    stamp_ns: int


def read_joint_state(data: bytes) -> JointPositions:
    """Return stamp, names and positions of a serialised JointState in any encoding.

    Raises:
        EncodingError: the bytes are incomplete or invalid.
    """
    if is_on("joint_state_encoding") and data[:2] == _LITTLE_ENDIAN_CDR:
        return read_joint_positions(data)
    return _read_by_rclpy(data)


def _read_by_rclpy(data: bytes) -> JointPositions:
    from rclpy.serialization import deserialize_message
    from sensor_msgs.msg import JointState

    try:
        message = deserialize_message(data, JointState)
    except RuntimeError as error:
        raise EncodingError(str(error)) from error
    stamp = message.header.stamp
    return JointPositions(
        tuple(message.name), np.array(message.position), stamp.sec * NANOSECONDS + stamp.nanosec
    )


def read_joint_positions(data: bytes) -> JointPositions:
    """Return stamp, names and positions of a JointState in little-endian CDR.

    Raises:
        EncodingError: the encoding is another one, or the bytes are incomplete or invalid.
    """
    if data[:2] != _LITTLE_ENDIAN_CDR:
        raise EncodingError("not little-endian CDR")
    try:
        seconds, nanoseconds, frame_bytes = _STAMP_AND_FRAME.unpack_from(data, _HEADER_BYTES)
        at = _HEADER_BYTES + _STAMP_AND_FRAME.size + frame_bytes
        names, at = _read_names(data, at)
        at += -at % 4
        (count,) = _COUNT.unpack_from(data, at)
        at += _COUNT.size
        at += -(at - _HEADER_BYTES) % 8 if count else 0
        positions = np.frombuffer(data, dtype="<f8", count=count, offset=at)
    except (struct.error, ValueError) as error:
        raise EncodingError(str(error)) from error
    return JointPositions(names, positions, seconds * NANOSECONDS + nanoseconds)


def _read_names(data: bytes, at: int) -> tuple[tuple[str, ...], int]:
    at += -at % 4
    (count,) = _COUNT.unpack_from(data, at)
    at += _COUNT.size
    names: list[str] = []
    for _ in range(count):
        at += -at % 4
        (size,) = _COUNT.unpack_from(data, at)
        at += _COUNT.size
        # The last byte is the terminating zero of the string.
        names.append(data[at : at + size - 1].decode())
        at += size
    return tuple(names), at
