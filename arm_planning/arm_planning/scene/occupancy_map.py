"""An octomap as an obstacle of the scene: its cubes joined into few boxes."""

from dataclasses import dataclass, field
from math import isfinite

import numpy as np

from arm_description.urdf.robot import Box
from arm_node.rigid_transform import RigidTransform
from arm_planning.scene.objects import CollisionObject, PlacedShape
from arm_planning.scene.octree import Cells, Cubes, refused

OCTOMAP = "<octomap>"
"""Its name in contacts and in the allowed collision matrix, as in MoveIt."""
MOST_CELLS = 1_000_000
"""Larger cubes are cut into the smallest ones, so that they join better, if these are fewer."""
MOST_BOXES = 20_000
"""More take seconds in each compilation of a collision model."""


@dataclass(frozen=True, slots=True, eq=False)
class OccupancyMap:
    """Occupied space.

    Attributes:
        resolution_m: edge of the smallest cube.
        cubes: the space, in such edges.
        pose: of the map's origin in the planning frame.
        obstacle: the same as boxes.
    """

    resolution_m: float
    cubes: Cubes
    pose: RigidTransform = RigidTransform()
    obstacle: CollisionObject = field(init=False)

    def __post_init__(self) -> None:
        """Make the boxes.

        Raises:
            PlanningError: the resolution is not a size, or there are too many boxes.
        """
        if not (isfinite(self.resolution_m) and self.resolution_m > 0.0):
            raise refused(f"its resolution is {self.resolution_m} m; it is finite and above 0")
        low, high = joined(self.cubes)
        if len(low) > MOST_BOXES:
            raise refused(
                f"it makes {len(low)} boxes, and at most {MOST_BOXES} are checked; take a larger "
                f"resolution than {self.resolution_m} m"
            )
        middles = 0.5 * self.resolution_m * (low + high)
        sizes = self.resolution_m * (high - low)
        shapes = tuple(
            PlacedShape(Box((x, y, z)), RigidTransform((u, v, w)))
            for (x, y, z), (u, v, w) in zip(sizes.tolist(), middles.tolist(), strict=True)
        )
        object.__setattr__(self, "obstacle", CollisionObject(OCTOMAP, self.pose, shapes))


def joined(cubes: Cubes) -> tuple[Cells, Cells]:
    """Return boxes that fill the same space: their lowest and highest corners, (n, 3) each."""
    low, edges = cubes.corners, cubes.edges
    if (edges.astype(float) ** 3).sum() <= MOST_CELLS:
        low, edges = _cut(low, edges)
    high = low + edges[:, None]
    for axis in range(3):
        low, high = _joined_along(axis, low, high)
    return low, high


def _cut(corners: Cells, edges: Cells) -> tuple[Cells, Cells]:
    """Cut cubes into the smallest ones."""
    parts = [corners[edges == 1]]
    for edge in np.unique(edges[edges > 1]):
        inside = np.indices((edge,) * 3).reshape(3, -1).T
        parts.append((corners[edges == edge][:, None] + inside).reshape(-1, 3))
    cells = np.concatenate(parts)
    return cells, np.ones(len(cells), np.int64)


def _joined_along(axis: int, low: Cells, high: Cells) -> tuple[Cells, Cells]:
    """Join boxes that follow one another along an axis and are the same across it."""
    if not len(low):
        return low, high
    across = [other for other in range(3) if other != axis]
    sides = np.concatenate([low[:, across], high[:, across]], axis=1)
    order = np.lexsort((low[:, axis], *sides.T))
    low, high, sides = low[order], high[order], sides[order]
    follows = (sides[1:] == sides[:-1]).all(axis=1) & (low[1:, axis] == high[:-1, axis])
    first = np.flatnonzero(np.concatenate([[True], ~follows]))
    last = np.concatenate([first[1:], [len(low)]]) - 1
    return low[first], high[last]
