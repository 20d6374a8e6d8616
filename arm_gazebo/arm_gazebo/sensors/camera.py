"""A camera of the robot: its lens, its rate and its topics.

The model of the lens is plumb_bob, that of OpenCV and CameraInfo. A point (x, y, z) of the optical
frame (z forward, x right, y down) is projected to (x / z, y / z), then moved by the distortion, and
last scaled to pixels by the camera matrix. The picture's upper left corner is the pixel position
(0, 0), and the centre of the first pixel is (0.5, 0.5), as in Gazebo.
"""

import math

import numpy as np
from numpy.typing import NDArray

from arm_node.frozen import frozen

Array = NDArray[np.float64]

UNDISTORTED = (0.0,) * 5
MAX_STEPS = 30
"""Limit on Newton's steps; from the guess along the radius, a few are enough."""
TOLERANCE = 1e-13
ACCEPTED = 1e-9
"""Largest error of a ray in x / z and y / z; a millionth of a pixel."""
RADII = 1025
"""Length of the table from which the first guess is interpolated."""
BLOCK = 1 << 16
"""Number of pixels that are solved together; more would leave the processor's cache."""
STEPS_INWARD = np.linspace(0.0, 1.0, 33)[:, np.newaxis]
"""Places between the principal point and the picture's edge where a model is examined."""
NEGLIGIBLE = 1e-12
"""Smallest coefficient that counts in the search for the radius where a model folds back."""


@frozen
class Lens:
    """A pinhole with a distortion.

    Attributes:
        fx: horizontal focal length in pixels.
        fy: vertical focal length in pixels.
        cx: column of the principal point, where the optical axis meets the picture.
        cy: row of the principal point.
        skew: pixels to the right for each unit of y / z.
        distortion: (5,) k1, k2, p1, p2, k3, in the order of CameraInfo.
    """

    fx: float
    fy: float
    cx: float
    cy: float
    skew: float = 0.0
    distortion: tuple[float, ...] = UNDISTORTED

    @property
    def is_distorted(self) -> bool:
        """Whether the distortion moves anything."""
        return any(self.distortion)

    @property
    def is_pinhole(self) -> bool:
        """Whether a perspective projection without skew gives the picture."""
        return not self.is_distorted and not self.skew

    @property
    def matrix(self) -> Array:
        """The camera matrix K, shape (3, 3)."""
        return np.array([[self.fx, self.skew, self.cx], [0.0, self.fy, self.cy], [0.0, 0.0, 1.0]])

    def rays(self, width: int, height: int) -> Array:
        """Return the rays through the centres of a picture's pixels.

        The lens has no `problem` with this size.

        Returns:
            x / z and y / z of each ray in the optical frame, shape (height, width, 2).
        """
        rays = np.empty((height, width, 2))
        columns = np.arange(width, dtype=np.float64) + 0.5
        rows = np.arange(height, dtype=np.float64)[:, np.newaxis] + 0.5
        rays[..., 0], rays[..., 1] = self._normalised(columns, rows)
        if self.is_distorted:
            flat = rays.reshape(-1, 2)
            for start in range(0, len(flat), BLOCK):
                block = flat[start : start + BLOCK]
                block[:, 0], block[:, 1] = self._undistorted(block[:, 0], block[:, 1])
        return rays

    def outline(self, width: int, height: int) -> Array:
        """Return the rays through a picture's edges, as `rays` does, shape (n, 2)."""
        return np.stack(self._undistorted(*self._edges(width, height)), axis=1)

    def problem(self, width: int, height: int) -> str:
        """Return why the distortion cannot be undone up to a picture's corners; empty if it can.

        A polynomial that was fitted to the middle of a picture may fold back further out: two rays
        meet at one pixel, and none at those beyond.
        """
        if not self.is_distorted:
            return ""
        wanted = self._edges(width, height)
        farthest = float(np.hypot(*wanted).max())
        fold = self._fold()
        if math.isfinite(fold):
            reached = float(self._along_radius(np.array(fold)))
            if reached <= farthest:
                return (
                    f"it folds back {reached * self.fx:.0f} pixels from the principal point (at "
                    f"x / z = {fold:.3g}), but the farthest corner of the picture is "
                    f"{farthest * self.fx:.0f} pixels away"
                )
        with np.errstate(all="ignore"):
            x, y = self._undistorted(*wanted)
            found = self._distorted(x, y)
            error = np.maximum(np.abs(found[0] - wanted[0]), np.abs(found[1] - wanted[1]))
            # The slopes are those of a potential. Where it is convex, no two rays meet.
            xx, xy, yy = self._slopes(x * STEPS_INWARD, y * STEPS_INWARD)
            is_convex = ((xx > 0) & (xx * yy > xy * xy)).all(axis=0)
            bad = ~((error < ACCEPTED) & (np.hypot(x, y) < fold) & is_convex)
        if bad.any():
            nearest = self.fx * float(np.hypot(wanted[0][bad], wanted[1][bad]).min())
            return f"it cannot be undone {nearest:.0f} pixels from the principal point"
        return ""

    def _normalised(self, u: Array, v: Array) -> tuple[Array, Array]:
        """Return pixel positions as x / z and y / z, still distorted."""
        y = (v - self.cy) / self.fy
        x = (u - self.cx) / self.fx
        return x - self.skew / self.fx * y if self.skew else x, y

    def _edges(self, width: int, height: int) -> tuple[Array, Array]:
        across, down = np.arange(width + 1.0), np.arange(height + 1.0)
        u = np.concatenate([across, across, np.zeros(height + 1), np.full(height + 1, width)])
        v = np.concatenate([np.zeros(width + 1), np.full(width + 1, height), down, down])
        return self._normalised(u, v)

    def _along_radius(self, r: Array) -> Array:
        """Return the radii r after the radial distortion."""
        k1, k2, _p1, _p2, k3 = self.distortion
        r2 = r * r
        return r * (1.0 + r2 * (k1 + r2 * (k2 + r2 * k3)))

    def _fold(self) -> float:
        """Return the radius beyond which the radial distortion falls; infinite if it never does."""
        k1, k2, _p1, _p2, k3 = self.distortion
        slope = [c if abs(c) > NEGLIGIBLE else 0.0 for c in (7 * k3, 5 * k2, 3 * k1)]
        roots = np.roots([*slope, 1.0])
        real = roots.real[(np.abs(roots.imag) < NEGLIGIBLE) & (roots.real > 0)]
        return math.sqrt(real.min()) if real.size else math.inf

    def _distorted(self, x: Array, y: Array) -> tuple[Array, Array]:
        k1, k2, p1, p2, k3 = self.distortion
        r2 = x * x + y * y
        radial = 1.0 + r2 * (k1 + r2 * (k2 + r2 * k3))
        return (
            x * radial + 2 * p1 * x * y + p2 * (r2 + 2 * x * x),
            y * radial + p1 * (r2 + 2 * y * y) + 2 * p2 * x * y,
        )

    def _slopes(self, x: Array, y: Array) -> tuple[Array, Array, Array]:
        """Return the derivatives of the distortion: dx/dx, dx/dy (equal to dy/dx) and dy/dy."""
        k1, k2, p1, p2, k3 = self.distortion
        r2 = x * x + y * y
        radial = 1.0 + r2 * (k1 + r2 * (k2 + r2 * k3))
        rise = 2 * (k1 + r2 * (2 * k2 + r2 * 3 * k3))
        return (
            radial + rise * x * x + 2 * p1 * y + 6 * p2 * x,
            rise * x * y + 2 * p1 * x + 2 * p2 * y,
            radial + rise * y * y + 6 * p1 * y + 2 * p2 * x,
        )

    def _undistorted(self, x: Array, y: Array) -> tuple[Array, Array]:
        """Solve the distortion for the ray by Newton's method."""
        if not self.is_distorted:
            return x, y
        wanted_x, wanted_y = x, y
        factor = self._first_guess(np.hypot(x, y))
        x, y = x * factor, y * factor
        for _ in range(MAX_STEPS):
            found_x, found_y = self._distorted(x, y)
            error_x, error_y = found_x - wanted_x, found_y - wanted_y
            if not max(np.abs(error_x).max(), np.abs(error_y).max()) > TOLERANCE:
                break
            xx, xy, yy = self._slopes(x, y)
            determinant = xx * yy - xy * xy
            x = x - (yy * error_x - xy * error_y) / determinant
            y = y - (xx * error_y - xy * error_x) / determinant
        return x, y

    def _first_guess(self, distorted: Array) -> Array:
        """Return the factors that undo the radial part for these radii, roughly."""
        farthest, fold = float(distorted.max()), self._fold()
        if math.isinf(fold):
            fold = 1.0
            while float(self._along_radius(np.array(fold))) < farthest:
                fold *= 2
        radii = np.linspace(0.0, fold, RADII)
        guess = np.interp(distorted, self._along_radius(radii), radii)
        return np.divide(guess, distorted, out=np.ones_like(distorted), where=distorted > 0)


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


COLOUR_BYTES, DEPTH_BYTES, POINT_BYTES = 3, 4, 16
"""Size of a pixel in an image, a depth image and a point cloud."""


@frozen
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
    def frame_bytes(self) -> int:
        """Size of the messages of one frame, if all topics have subscribers."""
        of_pixel = (
            COLOUR_BYTES * len(self.image_topics)
            + DEPTH_BYTES * len(self.depth_topics)
            + POINT_BYTES * len(self.points_topics)
        )
        return of_pixel * self.width * self.height

    @property
    def measures_depth(self) -> bool:
        """Whether the camera publishes depth or points."""
        return bool(self.depth_topics or self.points_topics)

    @property
    def nearest_drawn(self) -> float:
        """Distance in m at which the camera starts to draw."""
        return self.near * NEARER_SHARE if self.measures_depth else self.near
