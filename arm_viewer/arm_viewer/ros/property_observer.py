"""Ask a simulation for its gravity, and for mass and friction of a thing."""

from collections.abc import Callable
from dataclasses import replace

from rcl_interfaces.srv import GetParameters
from rclpy.node import Node

from arm_node.rigid_transform import Vector
from arm_viewer.ros.service_caller import ServiceCaller
from arm_viewer.world.world_view import ThingProperties

SERVICE = "/simulation/get_parameters"
GRAVITY, MASS, FRICTION = "gravity", "mass", "friction"


def parameter_of(thing: str, kind: str) -> str:
    """Return the name of a thing's parameter."""
    return f"entities.{thing}.{kind}"


class PropertyObserver:
    """Use it in the executor's thread.

    Attributes:
        gravity: in m/s²; None until the simulation says it.
        properties: of the thing that was asked for last.
    """

    def __init__(self, node: Node, changed: Callable[[], None]) -> None:
        """Create the clients; `changed` is called after each answer."""
        self._changed = changed
        # One for each question: an answer to several has nothing if one of them is unknown.
        self._callers = {
            kind: ServiceCaller(node, GetParameters, SERVICE) for kind in (GRAVITY, MASS, FRICTION)
        }
        self.gravity: Vector | None = None
        self.properties = ThingProperties()

    def ask(self, thing: str) -> None:
        """Ask for the gravity, and for a thing unless its name is empty."""
        if thing != self.properties.name:
            self.properties = ThingProperties(thing)
        self._callers[GRAVITY].ask(GetParameters.Request(names=[GRAVITY]), self._take_gravity)
        for kind in (MASS, FRICTION) if thing else ():
            self._callers[kind].ask(
                GetParameters.Request(names=[parameter_of(thing, kind)]),
                lambda answer, kind=kind: self._take(thing, kind, answer),
            )

    def close(self) -> None:
        """Destroy the clients."""
        for caller in self._callers.values():
            caller.close()

    def _take_gravity(self, answer: GetParameters.Response) -> None:
        numbers = tuple(value for each in answer.values for value in each.double_array_value)
        self.gravity = (numbers[0], numbers[1], numbers[2]) if len(numbers) == 3 else None
        self._changed()

    def _take(self, thing: str, kind: str, answer: GetParameters.Response) -> None:
        if thing != self.properties.name:
            return
        # Empty if there is no such parameter: a thing that is fixed has no mass.
        value = next((each.double_value for each in answer.values), None)
        if kind == MASS:
            self.properties = replace(self.properties, mass_kg=value)
        else:
            self.properties = replace(self.properties, friction=value)
        self._changed()
