"""The intrinsics of a camera in the form of ROS's CameraInfo."""

from dataclasses import dataclass

from arm_gazebo.sensors.camera import CameraSensor

DISTORTION_MODEL = "plumb_bob"


@dataclass(frozen=True, slots=True)
class Intrinsics:
    """Projection of a camera without distortion, row by row, in pixels.

    A point (x, y, z) in the optical frame appears at u = fx x / z + cx, v = fy y / z + cy. The
    image's upper left corner is (0, 0), and the centre of the first pixel is (0.5, 0.5).

    Attributes:
        k: (9,) camera matrix.
        d: (5,) distortion coefficients, all zero.
        r: (9,) rectification matrix, the identity.
        p: (12,) projection matrix.
    """

    k: tuple[float, ...]
    d: tuple[float, ...]
    r: tuple[float, ...]
    p: tuple[float, ...]

    @classmethod
    def of(cls, sensor: CameraSensor) -> "Intrinsics":
        """Return the intrinsics of a camera with square pixels and a centred optical axis."""
        f, cx, cy = sensor.focal_length, sensor.width / 2, sensor.height / 2
        return cls(
            k=(f, 0.0, cx, 0.0, f, cy, 0.0, 0.0, 1.0),
            d=(0.0,) * 5,
            r=(1.0, 0.0, 0.0, 0.0, 1.0, 0.0, 0.0, 0.0, 1.0),
            p=(f, 0.0, cx, 0.0, 0.0, f, cy, 0.0, 0.0, 0.0, 1.0, 0.0),
        )
