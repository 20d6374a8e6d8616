"""The intrinsics of a camera in the form of ROS's CameraInfo."""

from dataclasses import dataclass

from arm_gazebo.sensors.camera import CameraSensor

DISTORTION_MODEL = "plumb_bob"


@dataclass(frozen=True, slots=True)
class Intrinsics:
    """Projection of a camera, row by row, in pixels.

    A point (x, y, z) in the optical frame appears at u = fx x / z + cx, v = fy y / z + cy, moved by
    the distortion. The image's upper left corner is (0, 0), and the centre of the first pixel is
    (0.5, 0.5), as in Gazebo; OpenCV and image_geometry put it at (0, 0), so for them cx and cy are
    half a pixel less.

    Attributes:
        k: (9,) camera matrix.
        d: (5,) distortion coefficients k1, k2, p1, p2, k3.
        r: (9,) rectification matrix, the identity.
        p: (12,) projection matrix, that of the rectified image.
    """

    k: tuple[float, ...]
    d: tuple[float, ...]
    r: tuple[float, ...]
    p: tuple[float, ...]

    @classmethod
    def of(cls, sensor: CameraSensor) -> "Intrinsics":
        """Return the intrinsics of a camera."""
        lens = sensor.lens
        top, middle = (lens.fx, lens.skew, lens.cx), (0.0, lens.fy, lens.cy)
        return cls(
            k=(*top, *middle, 0.0, 0.0, 1.0),
            d=lens.distortion,
            r=(1.0, 0.0, 0.0, 0.0, 1.0, 0.0, 0.0, 0.0, 1.0),
            p=(*top, 0.0, *middle, 0.0, 0.0, 0.0, 1.0, 0.0),
        )
