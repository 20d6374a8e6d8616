"""What a user changes of a running world's physics: gravity, and mass and friction of a thing."""

import logging
import math
from collections.abc import Mapping, Sequence
from dataclasses import dataclass

import mujoco

from arm_gazebo.drives.servo_tuning import weak_drives
from arm_gazebo.errors import Refusal, RequestError
from arm_gazebo.physics.physics import Physics
from arm_gazebo.physics.world_properties import Gravity, bodies_of, shapes_of
from arm_gazebo.world.editor import WorldEditor
from arm_gazebo.world.entity import WorldEntity

MAX_GRAVITY_M_S2 = 100.0
"""In each direction. With more, a falling thing could pass the floor between two checks of
`physics.contact_gate`."""
MIN_MASS_KG, MAX_MASS_KG = 1e-6, 1e6
MAX_FRICTION = 100.0

logger = logging.getLogger(__name__)


@dataclass(frozen=True, slots=True)
class EntityProperties:
    """Physical properties of an entity.

    Attributes:
        mass_kg: mass of all that moves together; None for what is fixed to the world.
        friction: coefficient of sliding friction of its shapes, the lowest if they have several;
            None if it has no shape that touches anything.
    """

    mass_kg: float | None
    friction: float | None


class PropertyEditor:
    """Reads and changes the properties of a running world; on the thread of the world's editor.

    Robots keep the properties of their descriptions. All methods raise RequestError if they refuse
    a request; nothing has changed then.

    Args:
        editor: the world's editor.
        physics: the simulation, which belongs to another thread.
    """

    def __init__(self, editor: WorldEditor, physics: Physics) -> None:
        self._editor = editor
        self._physics = physics

    @property
    def gravity(self) -> Gravity:
        """The present gravity, m/s2."""
        x, y, z = self._editor.on_loop(lambda: self._physics.model.opt.gravity.tolist())
        return x, y, z

    def set_gravity(self, gravity: Sequence[float]) -> None:
        """Set the gravity, m/s2, shape (3,).

        The drives plan and hold under the new one. A drive that is too weak for it is logged.
        """
        changes = self._physics.properties.with_gravity(_checked_gravity(gravity))
        tuning = self._physics.tuning_for(changes)
        self._editor.on_loop(lambda: self._physics.set_properties(changes, tuning))
        self._editor.announce()
        for name, problem in weak_drives(self._editor.model, self._physics.servo.joints, tuning):
            logger.warning("joint '%s': %s", name, problem)

    def of_things(self) -> Mapping[str, EntityProperties]:
        """Return the properties of everything but robots, by name."""
        things = [entity for entity in self._editor.entities if not entity.is_robot]
        return self._editor.on_loop(
            lambda: {thing.name: _properties(self._physics, thing) for thing in things}
        )

    def of(self, name: str) -> EntityProperties:
        """Return the properties of an entity that is not a robot."""
        thing = self._thing(name)
        return self._editor.on_loop(lambda: _properties(self._physics, thing))

    def change(
        self, name: str, mass_kg: float | None = None, friction: float | None = None
    ) -> None:
        """Set properties of a thing; None leaves one as it is.

        Args:
            name: name of the entity.
            mass_kg: its mass; it becomes evenly denser or lighter, with all of its parts.
            friction: coefficient of sliding friction of all of its shapes.
        """
        thing = self._thing(name)
        [root], present = thing.roots, self.of(name)
        changes = self._physics.properties
        if mass_kg is not None:
            if present.mass_kg is None:
                raise RequestError(
                    Refusal.FAILED, f"'{name}' is fixed to the world: its mass has no effect"
                )
            mass = _checked(f"the mass of '{name}'", mass_kg, MIN_MASS_KG, MAX_MASS_KG, " kg")
            changes = changes.with_mass(root, mass)
        if friction is not None:
            if present.friction is None:
                raise RequestError(
                    Refusal.FAILED, f"'{name}' has no shape that touches anything: no friction"
                )
            changes = changes.with_friction(
                root, _checked(f"the friction of '{name}'", friction, 0.0, MAX_FRICTION)
            )
        self._editor.on_loop(lambda: self._physics.set_properties(changes))
        self._editor.announce()

    def _thing(self, name: str) -> WorldEntity:
        entity = self._editor.entities.find(name)
        if entity.is_robot:
            raise RequestError(
                Refusal.FAILED,
                f"'{name}' is a robot: its masses and friction are those of its description",
            )
        return entity


def _properties(physics: Physics, thing: WorldEntity) -> EntityProperties:
    """Return the properties of a thing. Loop thread."""
    return EntityProperties(
        _mass(physics, thing.roots[0]), _friction(physics.model, thing.roots[0])
    )


def _mass(physics: Physics, root: str) -> float | None:
    model = physics.model
    bodies = bodies_of(model, root)
    if not model.body_dofnum[bodies].any():
        return None
    # A sum of masses differs by its rounding from what the user has set.
    return physics.properties.masses.get(root, float(model.body_mass[bodies].sum()))


def _friction(model: mujoco.MjModel, root: str) -> float | None:
    shapes = shapes_of(model, root)
    touching = shapes[(model.geom_contype[shapes] | model.geom_conaffinity[shapes]) != 0]
    return float(model.geom_friction[touching, 0].min()) if len(touching) else None


def _checked_gravity(gravity: Sequence[float]) -> Gravity:
    try:
        x, y, z = map(float, gravity)
    except (TypeError, ValueError):
        x = y = z = math.nan
    if not all(abs(value) <= MAX_GRAVITY_M_S2 for value in (x, y, z)):
        raise RequestError(
            Refusal.FAILED,
            f"the gravity is three numbers x y z from -{MAX_GRAVITY_M_S2:g} to "
            f"{MAX_GRAVITY_M_S2:g} m/s2, not {_shown(gravity)}",
        )
    return x, y, z


def _checked(what: str, value: float, low: float, high: float, unit: str = "") -> float:
    try:
        number = float(value)
    except (TypeError, ValueError):
        number = math.nan
    if not low <= number <= high:
        raise RequestError(
            Refusal.FAILED, f"{what} is {low:g} to {high:g}{unit}, not {_shown(value)}{unit}"
        )
    return number


def _shown(value: object) -> str:
    """Return a user's value for a message, cut short."""
    return f"{value:g}" if isinstance(value, int | float) else str(value)[:80]
