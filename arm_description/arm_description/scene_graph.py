"""Scenes whose nodes use each other: how much they draw, before anybody tries to draw it."""

from collections.abc import Callable, Iterable
from dataclasses import dataclass

from arm_description.errors import MeshFileError

MOST_INSTANCES = 10_000
"""Geometries in the scene, each as often as its nodes are used: they take half a minute."""
DEEPEST = 100
"""How many nodes may lead to a geometry."""


@dataclass(frozen=True, slots=True)
class SceneNode:
    """What one node draws by itself, and the names of the nodes that it uses."""

    geometries: int
    uses: tuple[str, ...]


def check_scene(roots: Iterable[str], find: Callable[[str], SceneNode | None]) -> None:
    """Refuse few nodes that use each other so often that nobody could draw it.

    Args:
        roots: names of the nodes that are drawn.
        find: looks a node up; None where there is none of that name.

    Raises:
        MeshFileError: nodes that use themselves, too deep or too many.
    """
    counts: dict[str, int] = {}
    if sum(_instances(root, find, counts, ()) for root in roots) > MOST_INSTANCES:
        raise MeshFileError(f"it draws more than {MOST_INSTANCES} geometries")


def _instances(
    name: str,
    find: Callable[[str], SceneNode | None],
    counts: dict[str, int],
    above: tuple[str, ...],
) -> int:
    """Return how many geometries a node draws; `above` are the nodes that led to it."""
    if name in above:
        raise MeshFileError(f"its node '{name}' uses itself")
    if len(above) > DEEPEST:
        raise MeshFileError(f"its nodes use each other more than {DEEPEST} deep")
    if name not in counts:
        node = find(name) or SceneNode(0, ())
        below = (_instances(used, find, counts, (*above, name)) for used in node.uses)
        # Bounded, for there are numbers of many pages.
        counts[name] = min(node.geometries + sum(below), MOST_INSTANCES + 1)
    return counts[name]
