"""Random tables with boxes and cylinders, as a depth camera sees them, to judge what finds them.

The depths are computed, exact to rounding. Noise is added apart: independent for each pixel,
growing with the square of the depth, as that of a stereo camera.
"""

from collections.abc import Sequence
from dataclasses import dataclass
from math import cos, hypot, pi, radians, sin, tan
from typing import Literal

import cv2
import numpy as np
from numpy.typing import NDArray

from arm_node.rigid_transform import RigidTransform
from arm_planning.perception.table import SeenThing

Array = NDArray[np.float64]

RADII_M, CYLINDER_HEIGHTS_M = (0.012, 0.040), (0.030, 0.180)
SIDES_M, BOX_HEIGHTS_M = (0.025, 0.090), (0.030, 0.150)
MOST_THINGS = 6
FAR_M = 10.0
FROM_M, GAP_M = 0.7, 0.005
"""How far the camera is from the table, and things from each other at least."""
MARGIN = 3
"""Pixels between a thing and the picture's edge."""
CENTRE_M, SIZE_SHARE = 0.005, 0.1
"""Errors up to which a thing counts as found."""
HARDLY_SEEN = 0.2
"""Share of a thing's pixels below which it need not be found."""
NEAR_M = 0.02
"""How far from a hidden thing a part of it may be."""


@dataclass(frozen=True, slots=True)
class TableThing:
    """An upright box or cylinder on the table.

    Attributes:
        kind: "box" or "cylinder".
        position: x, y of its centre, in m.
        yaw: of a box, in rad.
        size: sides of a box; radius and height of a cylinder, in m.
    """

    kind: Literal["box", "cylinder"]
    position: tuple[float, float]
    yaw: float
    size: tuple[float, ...]

    def outline(self) -> Array:
        """Return points (n, 2) around its footprint; the corners of a box are among them."""
        if self.kind == "cylinder":
            angles = np.linspace(0, 2 * pi, 48, endpoint=False)
            return self.size[0] * np.stack([np.cos(angles), np.sin(angles)], axis=1) + self.position
        local = np.array([(1, 1), (-1, 1), (-1, -1), (1, -1)]) * self.size[:2] / 2
        corners = local @ self.turn()[:2, :2].T + self.position
        return np.linspace(corners, np.roll(corners, 1, axis=0), 4, endpoint=False).reshape(-1, 2)

    def turn(self) -> Array:
        """Return its rotation, (3, 3)."""
        c, s = cos(self.yaw), sin(self.yaw)
        return np.array([(c, -s, 0), (s, c, 0), (0, 0, 1)])

    def distances(self, points: Array) -> Array:
        """Return the distances (n,) of points (n, 2) from its footprint, negative inside."""
        local = (points - self.position) @ self.turn()[:2, :2]
        if self.kind == "cylinder":
            return np.hypot(*local.T) - self.size[0]
        out = np.abs(local) - np.array(self.size[:2]) / 2
        return np.hypot(*np.maximum(out, 0).T) + np.minimum(out.max(axis=1), 0)


@dataclass(frozen=True, slots=True)
class DepthCamera:
    """A depth camera above a table at z = 0, and where things stand.

    Attributes:
        width: pixels of a row.
        height: rows.
        hfov: horizontal field of view, in rad.
        pose: of the optical frame (x right, y down, z ahead) in the table's frame.
        low: least x, y of a thing's centre, in m.
        high: greatest x, y of a thing's centre, in m.
    """

    width: int
    height: int
    hfov: float
    pose: RigidTransform
    low: tuple[float, float]
    high: tuple[float, float]

    def rays(self) -> Array:
        """Return the rays (height, width, 3) of depth 1 in the optical frame."""
        focal = self.width / 2 / tan(self.hfov / 2)
        u = (np.arange(0.5, self.width) - self.width / 2) / focal
        v = (np.arange(0.5, self.height) - self.height / 2) / focal
        x, y = np.meshgrid(u, v)
        return np.stack([x, y, np.ones_like(x)], axis=2)

    def has_in_picture(self, thing: TableThing) -> bool:
        """Tell whether all of a thing is in the picture."""
        flat = thing.outline()
        solid = np.concatenate([np.insert(flat, 2, z, axis=1) for z in (0.0, thing.size[-1])])
        matrix = np.array(self.pose.inverse().matrix())
        x, y, z = (solid @ matrix[:3, :3].T + matrix[:3, 3]).T
        focal = self.width / 2 / tan(self.hfov / 2)
        across = np.abs(focal * x / z) < self.width / 2 - MARGIN
        down = np.abs(focal * y / z) < self.height / 2 - MARGIN
        return bool((across & down & (z > 0)).all())


def camera_at(angle: float) -> DepthCamera:
    """Return 640x480 pixels that look at the origin from an angle above the table."""
    pose = RigidTransform((-FROM_M * cos(angle), 0.0, FROM_M * sin(angle)))
    return DepthCamera(
        640, 480, 1.0756, pose.then(_looking_down(angle)), (-0.15, -0.15), (0.15, 0.15)
    )


def tutorial_camera() -> DepthCamera:
    """Return the myCobot's camera: 0.5 m up, 25 degrees down, things from 0.43 to 0.83 m ahead."""
    pose = RigidTransform((0.0, 0.0, 0.5)).then(_looking_down(radians(25)))
    return DepthCamera(424, 240, 1.5184, pose, (0.48, -0.2), (0.78, 0.2))


def _looking_down(angle: float) -> RigidTransform:
    """Return the rotation of an optical frame that looks along x, turned down by an angle."""
    pitch = RigidTransform(rotation=(0.0, sin(angle / 2), 0.0, cos(angle / 2)))
    return pitch.then(RigidTransform(rotation=(-0.5, 0.5, -0.5, 0.5)))


def random_table(random: np.random.Generator, camera: DepthCamera) -> tuple[TableThing, ...]:
    """Return one to six things wholly in the picture, with a gap of GAP_M at least between them."""
    things: list[TableThing] = []
    count = int(random.integers(1, MOST_THINGS + 1))
    while len(things) < count:
        thing = _random_thing(random, camera)
        if camera.has_in_picture(thing) and all(_gap(thing, other) >= GAP_M for other in things):
            things.append(thing)
    return tuple(things)


def _random_thing(random: np.random.Generator, camera: DepthCamera) -> TableThing:
    x, y = random.uniform(camera.low, camera.high).tolist()
    if random.random() < 0.5:
        radius, height = random.uniform(*RADII_M), random.uniform(*CYLINDER_HEIGHTS_M)
        return TableThing("cylinder", (x, y), 0.0, (radius, height))
    sides = random.uniform(*SIDES_M, 2).tolist()
    height = random.uniform(*BOX_HEIGHTS_M)
    return TableThing("box", (x, y), random.uniform(0, pi), (*sides, height))


def _gap(first: TableThing, second: TableThing) -> float:
    """Return the distance of two footprints; of two convex ones, a corner is at one of its ends."""
    return min(
        float(one.distances(other.outline()).min())
        for one, other in ((first, second), (second, first))
    )


@dataclass(frozen=True, slots=True, eq=False)
class TableSight:
    """What a camera sees of a table.

    Attributes:
        points: (height, width, 3) in the optical frame, in m; nan where nothing is.
        shares: for each thing, the share of its pixels that no other thing hides.
        whole: for each thing, that no pixel of it is beside one of a nearer thing.
    """

    points: Array
    shares: tuple[float, ...]
    whole: tuple[bool, ...]


def look(camera: DepthCamera, things: Sequence[TableThing]) -> TableSight:
    """Return what a camera without noise sees of a table."""
    rays = camera.rays()
    down = -(rays @ np.array(camera.pose.matrix())[2, :3])
    ground = camera.pose.position[2] / np.maximum(down, 1e-9)
    layers = np.stack([ground, *(_depths(camera, thing) for thing in things)])
    owner = layers.argmin(axis=0)
    depths = layers.min(axis=0)
    square = np.ones((3, 3), np.uint8)
    shares: list[float] = []
    whole: list[bool] = []
    for n in range(1, len(layers)):
        own = owner == n
        farthest = cv2.dilate(np.where(own, depths, 0), square)
        shares.append(float(own.sum() / max(np.isfinite(layers[n]).sum(), 1)))
        nearer = (owner > 0) & ~own & (depths < farthest)
        whole.append(bool(own.any() and not nearer.any()))
    depths[depths > FAR_M] = np.nan
    return TableSight(depths[..., None] * rays, tuple(shares), tuple(whole))


def _depths(camera: DepthCamera, thing: TableThing) -> Array:
    """Return the depths (height, width) at which a camera's rays meet a thing, or infinity."""
    turn = thing.turn()
    rays = camera.rays() @ np.array(camera.pose.matrix())[:3, :3].T @ turn
    eye = (np.array(camera.pose.position) - (*thing.position, 0)) @ turn
    with np.errstate(divide="ignore", invalid="ignore"):
        spans = [_between(eye[2], rays[..., 2], 0, thing.size[-1])]
        if thing.kind == "cylinder":
            square = (rays[..., :2] ** 2).sum(axis=-1)
            nearest = -(rays[..., :2] @ eye[:2]) / square
            off = hypot(*eye[:2]) ** 2 - thing.size[0] ** 2
            half = np.sqrt(nearest**2 - off / square)
            spans.append((nearest - half, nearest + half))
        else:
            halves = (thing.size[0] / 2, thing.size[1] / 2)
            spans += [_between(eye[k], rays[..., k], -h, h) for k, h in enumerate(halves)]
        enter = np.maximum.reduce([span[0] for span in spans])
        leave = np.minimum.reduce([span[1] for span in spans])
        return np.where((enter < leave) & (enter > 0), enter, np.inf)


def _between(eye: float, rays: Array, low: float, high: float) -> tuple[Array, Array]:
    """Return where rays enter and leave the space between two planes."""
    ends = (low - eye) / rays, (high - eye) / rays
    return np.minimum(*ends), np.maximum(*ends)


def noisy(points: Array, random: np.random.Generator, at_1m: float) -> NDArray[np.float32]:
    """Return points (h, w, 3) whose depths have noise: a standard deviation in m at 1 m depth."""
    depths = points[..., 2]
    factors = 1 + at_1m * depths * random.standard_normal(depths.shape)
    return (points * factors[..., None]).astype(np.float32)


def is_found(thing: TableThing, seen: SeenThing) -> bool:
    """Tell whether kind, centre (5 mm) and size (10 %) of a thing are right."""
    if thing.kind != seen.kind:
        return False
    centre = (*thing.position, thing.size[-1] / 2)
    sizes = [thing.size] if thing.kind == "cylinder" else [thing.size, _swapped(thing.size)]
    shares = min(float(np.abs(np.array(seen.size) / size - 1).max()) for size in sizes)
    distance = float(np.linalg.norm(np.array(seen.pose.position) - centre))
    return distance < CENTRE_M and shares < SIZE_SHARE


def _swapped(size: tuple[float, ...]) -> tuple[float, ...]:
    return (size[1], size[0], size[2])


def faults(things: Sequence[TableThing], sight: TableSight, seen: Sequence[SeenThing]) -> list[str]:
    """Return what is wrong with the things that were found on a table: a line each.

    A thing must be found; one that is not seen whole may be found in part instead, and one that is
    hardly seen may be missed. Nothing else may be found as a whole thing.
    """
    lines: list[str] = []
    right: set[int] = set()
    for thing, share, whole in zip(things, sight.shares, sight.whole, strict=True):
        found = {n for n, one in enumerate(seen) if not one.partial and is_found(thing, one)}
        right |= found
        parts = [
            one
            for one in seen
            if one.partial and thing.distances(np.array([one.pose.position[:2]]))[0] < NEAR_M
        ]
        if found or (not whole and (parts or share < HARDLY_SEEN)):
            continue
        lines.append(f"not found, {100 * share:.0f} % seen: {thing}")
    wrong = (one for n, one in enumerate(seen) if not one.partial and n not in right)
    return [*lines, *(f"not there: {one}" for one in wrong)]
