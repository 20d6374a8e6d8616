"""sensor_msgs/JointState read straight from its bytes.

A joint state that is thrown away by the throttle costs rclpy as much as one that is used: it
makes Python objects of every field, measured at six times what reading the few that count does.
The encoding is CDR (OMG DDS-RTPS 9.4.2.12): numbers aligned to their size counted from the end of
the four bytes of header, strings and sequences preceded by their count.
"""

import struct
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

NANOSECONDS = 1_000_000_000

_LITTLE_ENDIAN_CDR = b"\x00\x01"
_HEADER_BYTES = 4
_STAMP_AND_FRAME = struct.Struct("<iII")
_COUNT = struct.Struct("<I")


class EncodingError(ValueError):
    """Bytes that are no JointState in little-endian CDR."""


@dataclass(frozen=True, slots=True)
class JointPositions:
    """What moves the transforms: positions (n,) in rad or m of the joints `names`.

    `positions` may be of another length than `names`: that is the sender's doing.
    """

    names: tuple[str, ...]
    positions: NDArray[np.float64]
    stamp_ns: int


def read_joint_positions(data: bytes) -> JointPositions:
    """Return stamp, names and positions of a serialised JointState.

    Raises:
        EncodingError: another encoding, or bytes that end too early or make no sense.
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
        # The last byte is the zero that closes the string.
        names.append(data[at : at + size - 1].decode())
        at += size
    return tuple(names), at
