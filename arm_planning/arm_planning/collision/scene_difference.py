"""How two scenes differ, as far as a compiled scene is concerned."""

from collections.abc import Mapping, Sequence
from math import inf

import numpy as np

from arm_planning.robot.model import JointPositions
from arm_planning.scene.objects import CollisionObject, PlacedShape
from arm_planning.scene.scene import PlanningScene
from arm_planning.scene.shapes import TriangleMesh

STILL = 1e-6
"""Change of a joint that does not vary, rad or m, up to which a compiled scene serves: a joint that
holds trembles by less, and the proof allows for more."""


def same_robot(before: PlanningScene, scene: PlanningScene, varying: Sequence[str]) -> bool:
    """Return whether robot, attached bodies and allowed pairs are the same in two scenes.

    Args:
        before: a scene.
        scene: the other.
        varying: joints whose positions do not matter.
    """
    return (
        before.attached == scene.attached
        and before.allowed == scene.allowed
        and before.padding == scene.padding
        and before.scale == scene.scale
        and same_posture(before.positions, scene.positions, varying)
    )


def same_posture(before: JointPositions, after: JointPositions, varying: Sequence[str]) -> bool:
    """Return whether all joints but those that vary are where they were."""
    rest = (before.keys() | after.keys()) - set(varying)
    return all(abs(before.get(joint, inf) - after.get(joint, -inf)) < STILL for joint in rest)


def same_shapes(
    before: Mapping[str, CollisionObject], objects: Mapping[str, CollisionObject]
) -> bool:
    """Return whether objects with the same name have the same shapes, wherever they are."""
    return all(
        _have_same_shapes(before[name], thing) for name, thing in objects.items() if name in before
    )


def _have_same_shapes(first: CollisionObject, second: CollisionObject) -> bool:
    if first.shapes is second.shapes:
        return True
    return len(first.shapes) == len(second.shapes) and all(
        map(_is_same, first.shapes, second.shapes)
    )


def _is_same(first: PlacedShape, second: PlacedShape) -> bool:
    a, b = first.shape, second.shape
    if isinstance(a, TriangleMesh) and isinstance(b, TriangleMesh):
        same = np.array_equal(a.vertices, b.vertices) and np.array_equal(a.triangles, b.triangles)
    else:
        same = a == b
    return same and first.pose == second.pose
