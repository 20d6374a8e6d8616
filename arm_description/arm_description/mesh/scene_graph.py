"""Computes how much a scene draws when its nodes use each other, before it is drawn."""

from collections.abc import Callable, Iterable
from dataclasses import dataclass

from arm_description.errors import MeshFileError

MAX_INSTANCES = 10_000
"""Maximum geometries, each counted as often as it is used: they take half a minute."""
MAX_VISITS = 100_000
"""Maximum nodes, each counted as often as it is used: even empty ones take time."""
MAX_CORNERS = 30_000_000
"""Maximum corners of all triangles, each counted as often as it is drawn."""
MAX_DEPTH = 100
"""Maximum depth of nodes above a geometry."""


@dataclass(frozen=True, slots=True)
class SceneNode:
    """What one node draws itself, and the names of the nodes that it uses.

    Attributes:
        geometries: number of geometries that the node itself draws.
        uses: names of nodes, one for each use.
        corners: approximate number of corners of its triangles.
    """

    geometries: int
    uses: tuple[str, ...]
    corners: int = 0


@dataclass(frozen=True, slots=True)
class _Cost:
    geometries: int = 0
    visits: int = 0
    corners: int = 0

    def __add__(self, other: "_Cost") -> "_Cost":
        # Bounded, because the products can be astronomically large.
        return _Cost(
            min(self.geometries + other.geometries, MAX_INSTANCES + 1),
            min(self.visits + other.visits, MAX_VISITS + 1),
            min(self.corners + other.corners, MAX_CORNERS + 1),
        )


def check_scene(roots: Iterable[str], find: Callable[[str], SceneNode | None]) -> None:
    """Refuse a scene whose nodes use each other so often that it cannot be drawn.

    Args:
        roots: names of the nodes that are drawn.
        find: returns a node by name, or None.

    Raises:
        MeshFileError: nodes use themselves, or are too deep or too many.
    """
    costs: dict[str, _Cost] = {}
    total = sum((_cost(root, find, costs, ()) for root in roots), _Cost())
    if total.geometries > MAX_INSTANCES:
        raise MeshFileError(f"it draws more than {MAX_INSTANCES} geometries")
    if total.visits > MAX_VISITS:
        raise MeshFileError(f"its nodes are used more than {MAX_VISITS} times in all")
    if total.corners > MAX_CORNERS:
        raise MeshFileError(
            f"it draws triangles with more than {MAX_CORNERS} corners, each as often as it is used"
        )


def _cost(
    name: str,
    find: Callable[[str], SceneNode | None],
    costs: dict[str, _Cost],
    above: tuple[str, ...],
) -> _Cost:
    """Return the cost of a node and all nodes that it uses; `above` are the nodes above it."""
    if name in above:
        raise MeshFileError(f"its node '{name}' uses itself")
    if len(above) > MAX_DEPTH:
        raise MeshFileError(f"its nodes use each other more than {MAX_DEPTH} deep")
    if name not in costs:
        node = find(name) or SceneNode(0, ())
        below = (_cost(used, find, costs, (*above, name)) for used in node.uses)
        costs[name] = sum(below, _Cost(node.geometries, 1, node.corners) + _Cost())
    return costs[name]
