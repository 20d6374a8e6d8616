"""Gravity, and mass and friction of things, as parameters of the node that serves the world.

simulation_interfaces has no service for them. As parameters every client has them already, with
names, types, present values and a reason for each refusal.
"""

from array import array
from collections.abc import Iterator, Sequence
from typing import Any

from rclpy.node import Node
from rclpy.parameter import Parameter

from arm_gazebo.errors import RequestError
from arm_gazebo.physics.world_properties import PropertyChanges
from arm_gazebo.world.editor import WorldEditor
from arm_gazebo.world.entity_properties import (
    MAX_FRICTION,
    MAX_GRAVITY_M_S2,
    MAX_MASS_KG,
    MIN_MASS_KG,
    PropertyEditor,
    with_gravity,
)
from arm_node.frozen import frozen
from arm_node.parameters import check_changes, declare_typed, take_other_notations, type_of

GRAVITY = "gravity"
PREFIX, MASS, FRICTION = "entities", "mass", "friction"
WANTED = {
    GRAVITY: (
        "acceleration in the world, x y z in m/s2",
        f"three numbers from -{MAX_GRAVITY_M_S2:g} to {MAX_GRAVITY_M_S2:g}",
    ),
    MASS: (
        "mass in kg; the entity becomes evenly denser or lighter",
        f"a number from {MIN_MASS_KG:g} to {MAX_MASS_KG:g}",
    ),
    FRICTION: (
        "coefficient of sliding friction of all of the entity's shapes",
        f"a number from 0 to {MAX_FRICTION:g}",
    ),
}
"""Description and constraints of each kind of parameter."""


@frozen
class _Property:
    """What a parameter stands for.

    Attributes:
        kind: key of `WANTED`.
        value: the present value.
        entity: the entity; "" for the world.
    """

    kind: str
    value: Any
    entity: str = ""


class WorldParameters:
    """Declares a parameter for each property of the present world, and sets those that clients set.

    All of it runs on the executor of the node, which is the thread of the world's editor.
    """

    def __init__(self, node: Node, editor: WorldEditor, properties: PropertyEditor) -> None:
        self._node = node
        self._properties = properties
        self._present: dict[str, _Property] = {}
        self._follow()
        editor.watchers.append(self._follow)
        take_other_notations(node, GRAVITY)
        check_changes(node, self._take, RequestError)

    def _follow(self) -> None:
        """Declare, set and remove parameters, so that they are those of the present world."""
        before, self._present = self._present, dict(self._read())
        for name in before.keys() - self._present.keys():
            self._node.undeclare_parameter(name)
        for name, item in self._present.items():
            kind = type_of(item.value)
            if name not in before:
                declare_typed(self._node, name, kind, item.value, *WANTED[item.kind])
            elif item != before[name]:
                self._node.set_parameters([Parameter(name, kind, _plain(item.value))])

    def _read(self) -> Iterator[tuple[str, _Property]]:
        yield GRAVITY, _Property(GRAVITY, array("d", self._properties.gravity))
        for entity, found in self._properties.of_things().items():
            for kind, value in ((MASS, found.mass_kg), (FRICTION, found.friction)):
                if value is not None:
                    yield f"{PREFIX}.{entity}.{kind}", _Property(kind, value, entity)

    def _take(self, changed: Sequence[Parameter]) -> None:
        """Change the world as a client wishes, all or nothing."""
        changes = wanted = self._properties.changes
        for parameter in changed:
            item = self._present.get(parameter.name)
            # The parameters that follow the world have its values already.
            if item is not None and parameter.value != item.value:
                wanted = self._with(wanted, item, parameter.value)
        if wanted != changes:
            self._properties.apply(wanted)

    def _with(self, changes: PropertyChanges, item: _Property, value: Any) -> PropertyChanges:
        if item.kind == GRAVITY:
            return with_gravity(changes, value)
        mass, friction = (value if item.kind == kind else None for kind in (MASS, FRICTION))
        return self._properties.with_thing(changes, item.entity, mass, friction)


def _plain(value: Any) -> Any:
    """Return a value as rclpy takes it for its type."""
    return value.tolist() if isinstance(value, array) else value
