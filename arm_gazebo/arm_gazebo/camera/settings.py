"""The settings of a camera process, passed as one command-line argument."""

import json
from collections.abc import Mapping
from dataclasses import asdict, dataclass
from typing import Any

from arm_gazebo.errors import CameraError
from arm_gazebo.sensors.camera import CameraSensor

EXIT_BACKEND = 3
"""Exit code of a camera process whose render backend does not work; another one should be tried."""


@dataclass(frozen=True, slots=True)
class CameraSettings:
    """Settings that do not change while the simulation runs.

    Attributes:
        cameras: the cameras, in the order of the frames' indices.
        seed: seed of the noise.
        backend: the render backend: auto, egl, osmesa or raycast.
        excluded: backends that crashed an earlier process.
    """

    cameras: tuple[CameraSensor, ...]
    seed: int = 0
    backend: str = "auto"
    excluded: tuple[str, ...] = ()

    def to_json(self) -> str:
        """Return the settings as one line of text."""
        return json.dumps(asdict(self), separators=(",", ":"))

    @classmethod
    def from_json(cls, text: str) -> "CameraSettings":
        """Return the settings from their JSON text.

        Raises:
            CameraError: the text does not hold settings of this version.
        """
        try:
            values = json.loads(text)
            cameras = tuple(_sensor(camera) for camera in values.pop("cameras"))
            return cls(cameras, excluded=tuple(values.pop("excluded")), **values)
        except (ValueError, TypeError, KeyError, AttributeError) as error:
            raise CameraError(f"these are not settings of a camera process: {error}") from error


def _sensor(values: Mapping[str, Any]) -> CameraSensor:
    """Return the sensor with lists converted to tuples, which JSON lacks."""
    fixed: dict[str, Any] = {
        name: tuple(value) if isinstance(value, list) else value for name, value in values.items()
    }
    return CameraSensor(**fixed)
