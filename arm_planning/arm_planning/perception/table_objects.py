"""What is seen on a table as objects of the planning scene, and which of them is looked for."""

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np

from arm_description.urdf.robot import Box, Cylinder
from arm_node.rigid_transform import RigidTransform
from arm_planning.errors import PerceptionError
from arm_planning.perception.support_plane import Picture
from arm_planning.perception.table import SeenTable, SeenThing, find_things
from arm_planning.perception.view import Mask
from arm_planning.scene.objects import CollisionObject, PlacedShape

SHAPES = {"box": "[x, y, z]", "cylinder": "[height, radius]"}
"""Shapes that are found, and their dimensions as in shape_msgs/SolidPrimitive."""
MOST_FACTOR = 1.5
"""How much larger or smaller in each dimension the target may be than what is asked for."""
PLANE_NOISE = 4.0
"""Standard deviations up to which a point belongs to the surface."""
PLANE_FLOOR_M = 0.002
INVALID = "Invalid input parameters: target_shape or target_dimensions is empty"


@dataclass(frozen=True, slots=True)
class TableTarget:
    """A thing to look for.

    Attributes:
        shape: a key of `SHAPES`.
        dimensions: about these, in m, in the order given there.
    """

    shape: str
    dimensions: tuple[float, ...]

    def __post_init__(self) -> None:
        """Check them.

        Raises:
            PerceptionError: there is no such shape, or the dimensions are not its.
        """
        if not self.shape or not self.dimensions:
            raise PerceptionError(INVALID)
        if self.shape not in SHAPES:
            known = " and ".join(SHAPES)
            raise PerceptionError(f"no target_shape '{self.shape}' can be found; there are {known}")
        count = 3 if self.shape == "box" else 2
        if len(self.dimensions) != count or not all(0 < x < np.inf for x in self.dimensions):
            raise PerceptionError(
                f"target_dimensions of a {self.shape} are {SHAPES[self.shape]} in m, all above 0, "
                f"not {list(self.dimensions)}"
            )


@dataclass(frozen=True, slots=True)
class Crop:
    """The space in which things are looked for, in the target frame, in m."""

    low: tuple[float, float, float] = (-np.inf, -np.inf, -np.inf)
    high: tuple[float, float, float] = (np.inf, np.inf, np.inf)


@dataclass(frozen=True, slots=True)
class SeenObjects:
    """What is seen, in the frame of the camera's pose.

    Attributes:
        support: the surface that things stand on, as far as it is seen: a box, level with it.
        things: by their objects.
    """

    support: CollisionObject
    things: tuple[tuple[CollisionObject, SeenThing], ...]

    @property
    def objects(self) -> tuple[CollisionObject, ...]:
        """All of them, the support first."""
        return (self.support, *(thing for thing, _ in self.things))

    def target(self, target: TableTarget) -> str:
        """Return the id of the whole thing that is most like a target.

        Raises:
            PerceptionError: nothing is like it; the message says what there is.
        """
        alike = [(_factor(thing, target), each.id) for each, thing in self.things]
        factor, name = min(alike, default=(np.inf, ""))
        if factor <= MOST_FACTOR:
            return name
        wanted = f"{target.shape} of about {_metres(target.dimensions)}"
        seen = "; ".join(f"{each.id} {_described(thing)}" for each, thing in self.things)
        raise PerceptionError(f"no {wanted} is seen as a whole; there is {seen or 'nothing'}")


def objects_in_view(
    points: Picture,
    camera: RigidTransform,
    crop: Crop,
    support_name: str,
    thickness_m: float,
    robot: Mask | None = None,
) -> SeenObjects:
    """Return the objects that a depth camera sees on the largest level plane.

    Args:
        points: see `find_things`.
        camera: pose of the optical frame in the target frame, whose z axis is up.
        crop: where to look.
        support_name: id of the surface.
        thickness_m: of the surface, which is seen from above only.
        robot: (height, width), the pixels that show the robot.

    Raises:
        PerceptionError: there are no points in the crop, or no level plane among them.
    """
    matrix = np.array(camera.matrix())
    placed = points @ matrix[:3, :3].T.astype(np.float32) + matrix[:3, 3].astype(np.float32)
    # Written so that nan is outside.
    inside = np.all((placed >= np.array(crop.low)) & (placed <= np.array(crop.high)), axis=2)
    apart = ~inside if robot is None else ~inside | robot
    table = find_things(points, camera, apart)
    things: list[tuple[CollisionObject, SeenThing]] = []
    for thing in table.things:
        number = sum(other.kind == thing.kind for _, other in things)
        shape = Box(_sides(thing)) if thing.kind == "box" else Cylinder(*_round(thing))
        each = CollisionObject(f"{thing.kind}_{number}", thing.pose, (PlacedShape(shape),))
        things.append((each, thing))
    surface = placed[_on_surface(table, points) & ~apart].astype(np.float64)
    low, high = surface.min(axis=0), surface.max(axis=0)
    x, y, _ = (0.5 * (low + high)).tolist()
    top = float(np.median(surface[:, 2]))
    sides = (float(high[0] - low[0]), float(high[1] - low[1]), thickness_m)
    box = Box(sides)
    pose = RigidTransform((x, y, top - 0.5 * thickness_m))
    return SeenObjects(CollisionObject(support_name, pose, (PlacedShape(box),)), tuple(things))


def _on_surface(table: SeenTable, points: Picture) -> Mask:
    """Return which points are on the support."""
    noise = table.plane.noise * table.plane.distance * points[..., 2]
    with np.errstate(invalid="ignore"):
        return np.abs(table.plane.heights(points)) < PLANE_NOISE * noise + PLANE_FLOOR_M


def _factor(thing: SeenThing, target: TableTarget) -> float:
    """Return the largest ratio of a dimension of a thing and the target's, at least 1."""
    if thing.partial or thing.kind != target.shape:
        return np.inf
    size = np.array(thing.size if thing.kind == "box" else thing.size[::-1])
    ways = [size, size[[1, 0, 2]]] if thing.kind == "box" else [size]
    return float(np.exp(min(np.abs(np.log(way / target.dimensions)).max() for way in ways)))


def _described(thing: SeenThing) -> str:
    size = thing.size if thing.kind == "box" else thing.size[::-1]
    return f"of {_metres(size)}" + (" (seen in part)" if thing.partial else "")


def _metres(sizes: Sequence[float]) -> str:
    return " x ".join(f"{size:.3f}" for size in sizes) + " m"


def _sides(thing: SeenThing) -> tuple[float, float, float]:
    x, y, z = thing.size
    return (x, y, z)


def _round(thing: SeenThing) -> tuple[float, float]:
    radius, height = thing.size
    return (radius, height)
