"""A camera of the robot: its optics, its rate and its topics."""

import math
from dataclasses import dataclass

from arm_gazebo.sensors.lens import UNDISTORTED, Lens

DEFAULT_HFOV = 1.047
DEFAULT_SIZE = (320, 240)
DEFAULT_RATE_HZ = 30.0
DEFAULT_CLIP = (0.1, 100.0)
MAX_SIDE = 8192
"""Largest image side in pixels that common OpenGL drivers can render."""
NEARER_SHARE = 0.1
"""Fraction of the near clip distance at which a depth camera starts to draw. An object nearer
than the clip distance still hides what is behind it, and its pixels are reported as too near."""
SAME_FRAME = (1.0, 0.0, 0.0, 0.0, 0.0, 1.0, 0.0, 0.0, 0.0, 0.0, 1.0, 0.0)


@dataclass(frozen=True, slots=True)
class CameraSensor:
    """The optics, the rate and the topics of one camera.

    Attributes:
        name: unique in the robot, see `unique_names`; the MuJoCo camera has the same name.
        link: link that carries the camera, which looks along the link's x axis, z up.
        optical_frame: frame in the messages' headers: z forward, x right, y down.
        width: image width in pixels.
        height: image height in pixels.
        hfov: horizontal field of view in rad, in (0, pi); `intrinsics` override it.
        near: nearest visible distance in m.
        far: farthest visible distance in m.
        rate_hz: frames per second of simulation time.
        noise_mean: mean of the Gaussian noise: for a colour image a fraction of the full range,
            for depth the same number in m.
        noise_stddev: standard deviation of the noise in the same unit; 0 for no noise.
        image_topics: topics of the image; relative ones are in the node's namespace.
        info_topics: topics of the camera info.
        depth_topics: topics of the depth image.
        points_topics: topics of the point cloud.
        xyz: position of the camera in its link, in m.
        rpy: orientation of the camera in its link, in rad.
        optics_in_frame: (3, 4) row by row, pose of the optical axes (z forward, x right, y down)
            in `optical_frame`. It differs from the identity where the user names a frame that
            looks along x. Points are published in `optical_frame`.
        intrinsics: (5,) fx, fy, cx, cy and skew in pixels; empty for square pixels and a centred
            optical axis.
        distortion: (5,) k1, k2, p1, p2, k3.
    """

    name: str
    link: str
    optical_frame: str
    width: int = DEFAULT_SIZE[0]
    height: int = DEFAULT_SIZE[1]
    hfov: float = DEFAULT_HFOV
    near: float = DEFAULT_CLIP[0]
    far: float = DEFAULT_CLIP[1]
    rate_hz: float = DEFAULT_RATE_HZ
    noise_mean: float = 0.0
    noise_stddev: float = 0.0
    image_topics: tuple[str, ...] = ()
    info_topics: tuple[str, ...] = ()
    depth_topics: tuple[str, ...] = ()
    points_topics: tuple[str, ...] = ()
    xyz: tuple[float, float, float] = (0.0, 0.0, 0.0)
    rpy: tuple[float, float, float] = (0.0, 0.0, 0.0)
    optics_in_frame: tuple[float, ...] = SAME_FRAME
    intrinsics: tuple[float, ...] = ()
    distortion: tuple[float, ...] = UNDISTORTED

    @property
    def lens(self) -> Lens:
        """The projection."""
        if self.intrinsics:
            return Lens(*self.intrinsics, distortion=self.distortion)
        focal_length = self.width / 2 / math.tan(self.hfov / 2)
        middle = self.width / 2, self.height / 2
        return Lens(focal_length, focal_length, *middle, distortion=self.distortion)

    @property
    def topics(self) -> tuple[str, ...]:
        """Every topic of the camera."""
        return (*self.image_topics, *self.depth_topics, *self.points_topics, *self.info_topics)

    @property
    def measures_depth(self) -> bool:
        """Whether the camera publishes depth or points."""
        return bool(self.depth_topics or self.points_topics)

    @property
    def nearest_drawn(self) -> float:
        """Distance in m at which the camera starts to draw."""
        return self.near * NEARER_SHARE if self.measures_depth else self.near
