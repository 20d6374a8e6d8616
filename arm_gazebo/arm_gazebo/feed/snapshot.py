"""One state of the simulation as the cameras get it: a small datagram."""

import struct
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from arm_gazebo.errors import CameraError
from arm_gazebo.feed.schedule import FrameDue

HEADER = struct.Struct("<IdHII")
"""Model version, time, and how many frames, positions and mocap bodies follow."""
FRAME = struct.Struct("<HQQ")
POSE_SIZE = 7


@dataclass(frozen=True, slots=True)
class CameraSnapshot:
    """What a picture needs of a state.

    Attributes:
        model_version: which model `qpos` belongs to.
        time_s: simulation time of the state.
        frames: pictures to take of it.
        qpos: (nq,) generalised positions.
        mocap_poses: (nmocap, 7) position and quaternion (w x y z) of the mocap bodies.
    """

    model_version: int
    time_s: float
    frames: tuple[FrameDue, ...]
    qpos: NDArray[np.float64]
    mocap_poses: NDArray[np.float64]

    def pack(self) -> bytes:
        """Return the snapshot as bytes."""
        return b"".join(
            (
                HEADER.pack(
                    self.model_version,
                    self.time_s,
                    len(self.frames),
                    len(self.qpos),
                    len(self.mocap_poses),
                ),
                *(FRAME.pack(frame.camera, frame.number, frame.serial) for frame in self.frames),
                self.qpos.tobytes(),
                self.mocap_poses.tobytes(),
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
            expected = positions + mocaps * POSE_SIZE
            if len(values) != expected:
                raise ValueError(f"{len(values)} numbers, not {expected}")
            mocap_poses = values[positions:].reshape(mocaps, POSE_SIZE)
        except (struct.error, ValueError) as error:
            raise CameraError(f"{len(packed)} bytes are not a camera snapshot: {error}") from error
        return cls(version, time_s, due, values[:positions], mocap_poses)
