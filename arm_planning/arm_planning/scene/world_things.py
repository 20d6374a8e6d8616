"""Objects of the scene from the solids of a simulated world."""

from collections.abc import Collection, Iterable, Mapping
from dataclasses import dataclass, replace

import numpy as np
from numpy.typing import NDArray

from arm_description.urdf.robot import Box, Cylinder, Sphere
from arm_node.rigid_transform import RigidTransform
from arm_planning.scene.objects import CollisionObject, PlacedShape
from arm_planning.scene.scene import PlanningScene
from arm_planning.scene.shapes import Shape, TriangleMesh

Array = NDArray[np.float64]
EXACT_M = 1e-5
"""Corners of triangles that are nearer than this are one."""


@dataclass(frozen=True, slots=True, eq=False)
class WorldSolid:
    """One solid of a thing in the world.

    Attributes:
        owner: name of the thing.
        kind: "box", "ball", "cylinder" or "triangles".
        size: full sides in m.
        pose: its pose in the world.
        corners: corners of triangles, three points each, (3 n, 3).
    """

    owner: str
    kind: str
    size: tuple[float, float, float]
    pose: RigidTransform
    corners: Array


def objects_of_solids(
    solids: Iterable[WorldSolid], world: RigidTransform, links: Collection[str] = ()
) -> dict[str, CollisionObject]:
    """Return an object for each thing; it stands where its first solid stands.

    An ellipsoid becomes the ball about it, and an elliptic cylinder the round one about it.

    Args:
        solids: the solids of all things.
        world: the world's frame in the planning frame.
        links: names that no object may have: a thing called so, as the simulation calls the shapes
            of the world itself, gets an underscore.
    """
    shapes: dict[str, list[PlacedShape]] = {}
    for solid in solids:
        shape = _shape(solid)
        if shape is not None:
            placed = PlacedShape(shape, world.then(solid.pose))
            name = f"{solid.owner}_" if solid.owner in links else solid.owner
            shapes.setdefault(name, []).append(placed)
    objects: dict[str, CollisionObject] = {}
    for name, placed in shapes.items():
        origin = placed[0].pose
        inside = tuple(PlacedShape(each.shape, origin.inverse().then(each.pose)) for each in placed)
        objects[name] = CollisionObject(name, origin, inside)
    return objects


def followed(
    scene: PlanningScene,
    before: Mapping[str, CollisionObject],
    things: Mapping[str, CollisionObject],
) -> PlanningScene:
    """Return a scene with the things of the world as they are now, but for those that are attached.

    Args:
        scene: the scene.
        before: the things that it was last given.
        things: the things.
    """
    others = {name: each for name, each in scene.objects.items() if name not in before}
    present = {name: each for name, each in things.items() if name not in scene.attached}
    return replace(scene, objects={**others, **present})


def _shape(solid: WorldSolid) -> Shape | None:
    x, y, z = solid.size
    match solid.kind:
        case "box":
            return Box((x, y, z))
        case "ball":
            return Sphere(max(x, y, z) / 2.0)
        case "cylinder":
            return Cylinder(radius=max(x, y) / 2.0, length=z)
        case _:
            return _mesh(solid.corners)


def _mesh(corners: Array) -> TriangleMesh | None:
    """Return the triangles with shared corners, those without an area left out."""
    if not len(corners):
        return None
    rounded = np.round(corners / EXACT_M)
    _, first, index = np.unique(rounded, axis=0, return_index=True, return_inverse=True)
    triangles = index.reshape(-1, 3)
    whole = (np.diff(np.sort(triangles, axis=1), axis=1) > 0).all(axis=1)
    return TriangleMesh(corners[first], triangles[whole].astype(np.int64)) if whole.any() else None
