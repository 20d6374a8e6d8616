"""A camera of the robot: what it sees with, how often, and where its pictures go."""

import math
from dataclasses import dataclass

DEFAULT_HFOV = 1.047
DEFAULT_SIZE = (320, 240)
DEFAULT_RATE_HZ = 30.0
DEFAULT_CLIP = (0.1, 100.0)
NEARER_SHARE = 0.1
"""Share of the near clip from which on a depth camera draws: what is nearer than the clip hides
what is behind it, and is told from it."""
SAME_FRAME = (1.0, 0.0, 0.0, 0.0, 0.0, 1.0, 0.0, 0.0, 0.0, 0.0, 1.0, 0.0)


@dataclass(frozen=True, slots=True)
class CameraSensor:
    """What one camera sees with, how often, and where its pictures go.

    Attributes:
        name: unique in the robot, see `told_apart`; the MuJoCo camera has the same.
        link: link that carries the camera; it looks along the link's x axis, z up.
        optical_frame: frame of the messages' headers: z forward, x right, y down.
        width: picture's width in pixels.
        height: picture's height in pixels.
        hfov: horizontal field of view in rad, in (0, pi).
        near: nearest visible distance in m.
        far: farthest visible distance in m.
        rate_hz: frames per second of simulation time.
        noise_mean: mean of the Gaussian noise: of the picture, as a fraction of the full range;
            of a camera without picture of the depth, in m.
        noise_stddev: its standard deviation likewise; 0 for none.
        image_topics: topics of the picture; relative ones are in the node's namespace.
        info_topics: topics of the intrinsics.
        depth_topics: topics of the distances.
        points_topics: topics of the cloud of points.
        xyz: position of the camera in its link, in m.
        rpy: orientation of the camera in its link, in rad.
        optics_in_frame: (3, 4) row by row, pose of z forward, x right, y down in `optical_frame`,
            which Gazebo's users may call one that looks along x; points are in that frame.
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

    @property
    def focal_length(self) -> float:
        """Focal length in pixels, the same along both axes: pixels are square."""
        return self.width / 2 / math.tan(self.hfov / 2)

    @property
    def vfov(self) -> float:
        """Vertical field of view in rad; MuJoCo's `fovy` is this in degrees."""
        return 2 * math.atan(self.height / 2 / self.focal_length)

    @property
    def topics(self) -> tuple[str, ...]:
        """Every topic of the camera."""
        return (*self.image_topics, *self.depth_topics, *self.points_topics, *self.info_topics)

    @property
    def measures_depth(self) -> bool:
        """Whether distances are among what it shows."""
        return bool(self.depth_topics or self.points_topics)

    @property
    def nearest_drawn(self) -> float:
        """From which distance on things are drawn, in m."""
        return self.near * NEARER_SHARE if self.measures_depth else self.near
