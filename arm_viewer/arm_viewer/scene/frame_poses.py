"""Where frames are in the root of their tree, from where each is in its parent."""

from collections.abc import Mapping
from dataclasses import dataclass

from arm_viewer.snapshot import Transform

Vector = tuple[float, float, float]
Quaternion = tuple[float, float, float, float]


@dataclass(frozen=True, slots=True)
class FramePose:
    """Position in m and the unit quaternion (x, y, z, w) of a frame in its root."""

    position: Vector = (0.0, 0.0, 0.0)
    rotation: Quaternion = (0.0, 0.0, 0.0, 1.0)

    def then(self, step: Transform) -> "FramePose":
        """Return the pose of a frame that `step` puts into this one."""
        x, y, z = rotated(self.rotation, step.position)
        px, py, pz = self.position
        return FramePose((px + x, py + y, pz + z), product(self.rotation, step.rotation))


def frame_poses(transforms: Mapping[str, Transform]) -> dict[str, FramePose]:
    """Return the pose of every frame, roots included; frames in a circle have none."""
    poses: dict[str, FramePose] = {}
    for frame in transforms:
        chain: dict[str, Transform] = {}
        while frame not in poses and frame in transforms and frame not in chain:
            chain[frame] = transforms[frame]
            frame = transforms[frame].parent
        if frame in chain:
            continue
        pose = poses.setdefault(frame, FramePose())
        for child, step in reversed(chain.items()):
            pose = poses[child] = pose.then(step)
    return poses


def product(first: Quaternion, second: Quaternion) -> Quaternion:
    """Return the quaternion that turns by `second`, then by `first`."""
    x, y, z, w = first
    a, b, c, d = second
    return (
        w * a + x * d + y * c - z * b,
        w * b - x * c + y * d + z * a,
        w * c + x * b - y * a + z * d,
        w * d - x * a - y * b - z * c,
    )


def rotated(rotation: Quaternion, vector: Vector) -> Vector:
    """Return a vector turned by a unit quaternion."""
    x, y, z, w = rotation
    a, b, c = vector
    # v + 2 w (u x v) + 2 u x (u x v), with u the quaternion's vector part.
    p, q, r = 2 * (y * c - z * b), 2 * (z * a - x * c), 2 * (x * b - y * a)
    return (
        a + w * p + y * r - z * q,
        b + w * q + z * p - x * r,
        c + w * r + x * q - y * p,
    )
