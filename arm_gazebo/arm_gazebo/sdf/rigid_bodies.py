"""Group the parts of an SDF model into rigid bodies.

The links of one <model> are a rigid body, together with the links of a nested model that a joint
connects to them. A nested model without such a joint is a separate body, as in Gazebo: a cup on a
table.
"""

from collections.abc import Iterator, Sequence

import numpy as np

from arm_gazebo.sdf.element import SdfElement
from arm_gazebo.sdf.frames import SEPARATOR
from arm_gazebo.sdf.scope import Matrix, SdfScope
from arm_node.frozen import frozen

WORLD = "world"


@frozen
class _ModelPart:
    """A model, or a model nested in it.

    Attributes:
        name: prefix of its link names, before `::`.
        scope: its content.
        frame: (4, 4) pose in the outermost model.
        static: whether it, or a model that contains it, is declared static.
    """

    name: str
    scope: SdfScope
    frame: Matrix
    static: bool


@frozen
class RigidBody:
    """Parts that move together or are static; `frame` is the (4, 4) pose in the outermost model."""

    name: str
    frame: Matrix
    parts: tuple[_ModelPart, ...]
    static: bool


def rigid_bodies(scope: SdfScope, name: str, static: bool | None = None) -> list[RigidBody]:
    """Return the rigid bodies of a model; usually there is one.

    `static` overrides the model's <static>; None keeps it.

    Raises:
        WorldError: a pose or a flag is invalid.
    """
    is_static = scope.element.flag("static") if static is None else static
    parts = list(_parts(scope, name, np.eye(4), is_static))
    joint_groups = _JointGroups(parts)
    groups: dict[int, list[_ModelPart]] = {}
    for index, part in enumerate(parts):
        groups.setdefault(joint_groups.group(index), []).append(part)
    static_groups = [
        group
        for key, group in groups.items()
        if key == joint_groups.ground or any(part.static for part in group)
    ]
    static_parts = [part for group in static_groups for part in group]
    bodies = [(static_parts, True)] if static_parts else []
    bodies += [(group, False) for group in groups.values() if group not in static_groups]
    # A group without links cannot move.
    bodies = [(group, s) for group, s in bodies if any(p.scope.links for p in group)] or bodies[:1]
    bodies.sort(key=lambda body: parts[0] not in body[0])
    return [_body(group, static, parts[0], len(bodies)) for group, static in bodies]


def _body(group: list[_ModelPart], static: bool, outermost: _ModelPart, count: int) -> RigidBody:
    """Name a body after the outermost model if it contains that model or is the only body."""
    first = outermost if count == 1 or outermost in group else group[0]
    return RigidBody(first.name, first.frame, tuple(group), static)


def _parts(scope: SdfScope, name: str, frame: Matrix, static: bool) -> Iterator[_ModelPart]:
    yield _ModelPart(name, scope, frame, static)
    for model in scope.models.values():
        inner = name if model.merged else f"{name}{SEPARATOR}{model.name}"
        placed = frame @ scope.frames.matrix(model.pose_source)
        yield from _parts(model.scope, inner, placed, static or bool(model.static))


class _JointGroups:
    """Groups the parts that joints connect to each other or to the world (union-find)."""

    def __init__(self, parts: Sequence[_ModelPart]) -> None:
        self.ground_index = len(parts)
        self._group_of = list(range(len(parts) + 1))
        self._index = {id(part.scope): index for index, part in enumerate(parts)}
        for index, part in enumerate(parts):
            for model in part.scope.models.values():
                if model.merged:
                    self._join(index, self._index[id(model.scope)])
            for joint in part.scope.joints:
                ends = [self._end(part.scope, joint.text(end)) for end in ("parent", "child")]
                if None not in ends:
                    self._join(*(end for end in ends if end is not None))

    @property
    def ground(self) -> int:
        """The group of the parts that are connected to the world."""
        return self.group(self.ground_index)

    def group(self, index: int) -> int:
        """Return the number of a part's group; connected parts have the same number."""
        while self._group_of[index] != index:
            index = self._group_of[index]
        return index

    def _join(self, one: int, other: int) -> None:
        self._group_of[self.group(one)] = self.group(other)

    def _end(self, scope: SdfScope, name: str) -> int | None:
        """Return the part that a frame belongs to; None if there is no such frame."""
        visited = set[tuple[int, str]]()
        while (id(scope), name) not in visited:
            visited.add((id(scope), name))
            if name == WORLD:
                return self.ground_index
            part = scope.parts.get(name)
            outer, separator, rest = name.partition(SEPARATOR)
            merged = [m for m in scope.models.values() if m.merged and m.scope.frames.knows(name)]
            if part is not None:
                if part.tag == "link" or not (name := _holder(part)):
                    return self._index[id(scope)]
            elif outer in scope.models:
                scope, name = scope.models[outer].scope, rest if separator else ""
            elif merged:
                scope = merged[0].scope
            else:
                return self._index[id(scope)] if name in ("", "__model__") else None
        return None


def _holder(part: SdfElement) -> str:
    """Return the name of the frame that a joint or frame is fixed to, "" for its model."""
    return part.text("child") if part.tag == "joint" else part.attribute("attached_to")
