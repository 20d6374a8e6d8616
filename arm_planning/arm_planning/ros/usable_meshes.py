"""Keeps meshes out of the scene that collision checks cannot use: each plan would fail for them."""

from collections.abc import Iterable, Mapping
from dataclasses import replace
from typing import TypeVar

from arm_planning.collision.model import CollisionModel
from arm_planning.errors import PlanningError
from arm_planning.robot.model import PlanningModel
from arm_planning.scene.objects import AttachedBody, CollisionObject
from arm_planning.scene.scene import PlanningScene
from arm_planning.scene.shapes import TriangleMesh

ThingT = TypeVar("ThingT", CollisionObject, AttachedBody)


def without_unusable(
    model: PlanningModel, before: PlanningScene, after: PlanningScene
) -> tuple[PlanningScene, list[PlanningError]]:
    """Return a changed scene in which objects with unusable meshes are as before, and the reasons.

    Args:
        model: the robot.
        before: the scene before the change, whose meshes are usable.
        after: the scene after it.
    """
    known = {id(mesh) for thing in _things(before) for mesh in _meshes(thing)}
    new = [
        thing for thing in _things(after) if any(id(mesh) not in known for mesh in _meshes(thing))
    ]
    if not new or _problem(model, after, new) is None:
        return after, []
    problems = {thing.id: _problem(model, after, [thing]) for thing in new}
    unusable = {name: problem for name, problem in problems.items() if problem is not None}
    kept = replace(
        after,
        objects=_as_before(before.objects, after.objects, unusable),
        attached=_as_before(before.attached, after.attached, unusable),
    )
    return kept, list(unusable.values())


def _things(scene: PlanningScene) -> list[CollisionObject]:
    return [*scene.objects.values(), *(body.object for body in scene.attached.values())]


def _meshes(thing: CollisionObject) -> list[TriangleMesh]:
    shapes = (placed.shape for placed in thing.shapes)
    return [shape for shape in shapes if isinstance(shape, TriangleMesh)]


def _problem(
    model: PlanningModel, scene: PlanningScene, things: Iterable[CollisionObject]
) -> PlanningError | None:
    alone = PlanningScene(scene.positions, objects={thing.id: thing for thing in things})
    try:
        CollisionModel(model, alone)
    except PlanningError as error:
        return error
    return None


def _as_before(
    before: Mapping[str, ThingT], after: Mapping[str, ThingT], names: Iterable[str]
) -> dict[str, ThingT]:
    unusable = set(names)
    restored = {name: thing for name, thing in before.items() if name in unusable}
    return {name: thing for name, thing in after.items() if name not in unusable} | restored
