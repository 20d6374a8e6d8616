"""One state of the simulation as the cameras receive it: a small datagram."""

import struct
from typing import Any

import numpy as np
from numpy.typing import NDArray

from arm_gazebo.errors import CameraError
from arm_gazebo.feed.schedule import FrameDue
from arm_node.frozen import frozen

HEADER = struct.Struct("<IdHII")
"""Model version, time, and the numbers of frames, positions and mocap bodies that follow."""
FRAME = struct.Struct("<HQQ")


@frozen
class CameraSnapshot:
    """The part of a state that a picture needs.

    Attributes:
        model_version: the model that `qpos` belongs to.
        time_s: simulation time of the state.
        frames: camera frames to render from it.
        qpos: (nq,) generalised positions.
        mocap_positions: (nmocap, 3) of the mocap bodies.
        mocap_quaternions: (nmocap, 4) of the mocap bodies, w x y z.
    """

    model_version: int
    time_s: float
    frames: tuple[FrameDue, ...]
    qpos: NDArray[np.float64]
    mocap_positions: NDArray[np.float64]
    mocap_quaternions: NDArray[np.float64]

    @classmethod
    def of(
        cls, data: Any, time_s: float, version: int = 0, frames: tuple[FrameDue, ...] = ()
    ) -> "CameraSnapshot":
        """Return the snapshot of MuJoCo's data, whose arrays it shares."""
        return cls(version, time_s, frames, data.qpos, data.mocap_pos, data.mocap_quat)

    def pack(self) -> bytes:
        """Return the snapshot as bytes."""
        return b"".join(
            (
                HEADER.pack(
                    self.model_version,
                    self.time_s,
                    len(self.frames),
                    len(self.qpos),
                    len(self.mocap_positions),
                ),
                *(FRAME.pack(frame.camera, frame.number, frame.serial) for frame in self.frames),
                self.qpos.tobytes(),
                self.mocap_positions.tobytes(),
                self.mocap_quaternions.tobytes(),
            )
        )

    @classmethod
    def unpack(cls, packed: bytes) -> "CameraSnapshot":
        """Return the snapshot that was packed.

        Raises:
            CameraError: the bytes are not a snapshot.
        """
        try:
            version, time_s, frames, positions, mocaps = HEADER.unpack_from(packed)
            values_at = HEADER.size + frames * FRAME.size
            due = tuple(
                FrameDue(*fields) for fields in FRAME.iter_unpack(packed[HEADER.size : values_at])
            )
            values = np.frombuffer(packed, np.float64, offset=values_at)
            quaternions_at = positions + 3 * mocaps
            expected = quaternions_at + 4 * mocaps
            if len(values) != expected:
                raise ValueError(f"{len(values)} numbers, not {expected}")
            mocap_positions = values[positions:quaternions_at].reshape(mocaps, 3)
            mocap_quaternions = values[quaternions_at:].reshape(mocaps, 4)
        except (struct.error, ValueError) as error:
            raise CameraError(f"{len(packed)} bytes are not a camera snapshot: {error}") from error
        return cls(version, time_s, due, values[:positions], mocap_positions, mocap_quaternions)
