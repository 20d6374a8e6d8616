"""The frames of the myCobot's protocol, as bytes. No input or output.

A frame is FE FE, a length, a command, data and FA. The length counts command, data and the end.
There is no checksum. Numbers of two bytes have the high byte first; angles are in 0.01 degree.
"""

import math
from collections.abc import Sequence
from enum import IntEnum

HEADER = b"\xfe\xfe"
END = 0xFA
AROUND_DATA = 5
"""Bytes of a frame beside its data."""
RAD_PER_UNIT = math.radians(0.01)
JOINTS = 6


class MyCobotCommand(IntEnum):
    """What a frame asks for, and its reply repeats."""

    READ_ERROR = 0x07
    POWER_ON = 0x10
    IS_POWERED = 0x12
    RELEASE = 0x13
    SET_FRESH_MODE = 0x16
    READ_ANGLES = 0x20
    SEND_ANGLES = 0x22
    READ_GRIPPER = 0x65
    SEND_GRIPPER = 0x67


REPLY_SIZES = {
    MyCobotCommand.READ_ERROR: 1,
    MyCobotCommand.IS_POWERED: 1,
    MyCobotCommand.READ_ANGLES: 2 * JOINTS,
    MyCobotCommand.READ_GRIPPER: 1,
}
"""Bytes of data in the replies that are waited for."""


def request(command: MyCobotCommand, data: bytes = b"") -> bytes:
    """Return a frame."""
    return HEADER + bytes((len(data) + 2, command)) + data + bytes((END,))


def angles_request(angles: Sequence[float], speed: int) -> bytes:
    """Return the request to go to these angles, in rad, at a speed from 1 to 100."""
    units = b"".join(
        round(angle / RAD_PER_UNIT).to_bytes(2, "big", signed=True) for angle in angles
    )
    return request(MyCobotCommand.SEND_ANGLES, units + bytes((speed,)))


def angles_of(data: bytes) -> tuple[float, ...]:
    """Return the angles in a reply's data, in rad."""
    return tuple(
        RAD_PER_UNIT * int.from_bytes(data[at : at + 2], "big", signed=True)
        for at in range(0, len(data), 2)
    )


def reply_data(received: bytes, command: MyCobotCommand) -> bytes | None:
    """Return the data of the first whole reply to a command; None while there is none.

    Frames of another command or length are skipped, and bytes between frames, too.
    """
    count = REPLY_SIZES[command]
    start = received.find(HEADER)
    while start >= 0:
        frame = received[start : start + count + AROUND_DATA]
        head = bytes((count + 2, command))
        if frame[2:4] == head and len(frame) == count + AROUND_DATA and frame[-1] == END:
            return frame[4:-1]
        start = received.find(HEADER, start + 1)
    return None
