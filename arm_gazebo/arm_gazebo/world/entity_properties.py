"""What a user changes of a running world's physics: gravity, and mass and friction of a thing."""

import logging
import math
from collections.abc import Mapping, Sequence

import mujoco
import numpy as np
from numpy.typing import NDArray

from arm_gazebo.drives.servo_tuning import ServoTuning, weak_drives
from arm_gazebo.errors import Refusal, RequestError
from arm_gazebo.physics.physics import Physics
from arm_gazebo.physics.world_properties import Gravity, PropertyChanges, bodies_of, shapes_of
from arm_gazebo.world.editor import WorldEditor
from arm_node.frozen import frozen

MAX_GRAVITY_M_S2 = 100.0
"""In each direction. With more, a falling thing could pass the floor between two checks of
`physics.contact_gate`."""
MIN_MASS_KG, MAX_MASS_KG = 1e-6, 1e6
MAX_FRICTION = 100.0

logger = logging.getLogger(__name__)


@frozen
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
    """

    def __init__(self, editor: WorldEditor, physics: Physics) -> None:
        self._editor = editor
        self._physics = physics

    @property
    def changes(self) -> PropertyChanges:
        """What the user has changed so far."""
        return self._editor.on_loop(lambda: self._physics.properties)

    @property
    def gravity(self) -> Gravity:
        """The present gravity, m/s2."""
        x, y, z = self._editor.on_loop(lambda: self._physics.model.opt.gravity.tolist())
        return x, y, z

    def set_gravity(self, gravity: Sequence[float]) -> None:
        """Set the gravity, m/s2, shape (3,); see `apply`."""
        self.apply(with_gravity(self.changes, gravity))

    def of_things(self) -> Mapping[str, EntityProperties]:
        """Return the properties of everything but robots, by name."""
        present = self._present()
        return {
            entity.name: present.of(entity.roots[0])
            for entity in self._editor.entities
            if not entity.is_robot
        }

    def of(self, name: str) -> EntityProperties:
        """Return the properties of an entity that is not a robot."""
        return self._present().of(self._root(name))

    def change(
        self, name: str, mass_kg: float | None = None, friction: float | None = None
    ) -> None:
        """Set properties of a thing; see `with_thing`."""
        self.apply(self.with_thing(self.changes, name, mass_kg, friction))

    def with_thing(
        self,
        changes: PropertyChanges,
        name: str,
        mass_kg: float | None = None,
        friction: float | None = None,
    ) -> PropertyChanges:
        """Return the changes with properties of a thing; None leaves one as it is.

        `mass_kg` makes it evenly denser or lighter, with all of its parts; `friction` is the
        coefficient of sliding friction of all of its shapes.
        """
        root = self._root(name)
        present = self._present().of(root)
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
            value = _checked(f"the friction of '{name}'", friction, 0.0, MAX_FRICTION)
            changes = changes.with_friction(root, value)
        return changes

    def apply(self, changes: PropertyChanges) -> None:
        """Continue with these changes and no others, all before the next tick.

        The drives plan and hold under another gravity. A drive that is too weak for it is logged.
        """
        physics, tuning = self._physics, None
        known = self._weak_drives(physics.servo.tuning)
        if changes.gravity != self.changes.gravity:
            tuning = physics.tuning_for(changes)
        self._editor.on_loop(lambda: physics.set_properties(changes, tuning))
        self._editor.announce()
        for name, problem in sorted(self._weak_drives(physics.servo.tuning) - known):
            logger.warning("joint '%s': %s", name, problem)

    def _weak_drives(self, tuning: ServoTuning) -> set[tuple[str, str]]:
        return set(weak_drives(self._editor.model, self._physics.servo.joints, tuning))

    def _root(self, name: str) -> str:
        """Return the top-level body of an entity that is not a robot."""
        entity = self._editor.entities.find(name)
        if entity.is_robot:
            raise RequestError(
                Refusal.FAILED,
                f"'{name}' is a robot: its masses and friction are those of its description",
            )
        return entity.roots[0]

    def _present(self) -> "_PresentProperties":
        physics, model = self._physics, self._editor.model
        # Only copied on the loop's thread, because looking through many things takes long.
        masses, frictions, changes = self._editor.on_loop(
            lambda: (model.body_mass.copy(), model.geom_friction[:, 0].copy(), physics.properties)
        )
        return _PresentProperties(model, masses, frictions, changes)


@frozen
class _PresentProperties:
    """Copies of what changes in a model.

    Attributes:
        model: the model, for what does not change.
        masses: of the bodies, kg, shape (nbody,).
        frictions: of the shapes, shape (ngeom,).
        changes: what the user has changed.
    """

    model: mujoco.MjModel
    masses: NDArray[np.float64]
    frictions: NDArray[np.float64]
    changes: PropertyChanges

    def of(self, root: str) -> EntityProperties:
        """Return the properties of a top-level body with all that is attached to it."""
        return EntityProperties(self._mass(root), self._friction(root))

    def _mass(self, root: str) -> float | None:
        bodies = bodies_of(self.model, root)
        if not self.model.body_dofnum[bodies].any():
            return None
        # A sum of masses differs by its rounding from what the user has set.
        return self.changes.masses.get(root, float(self.masses[bodies].sum()))

    def _friction(self, root: str) -> float | None:
        model, shapes = self.model, shapes_of(self.model, root)
        touching = shapes[(model.geom_contype[shapes] | model.geom_conaffinity[shapes]) != 0]
        return float(self.frictions[touching].min()) if len(touching) else None


def with_gravity(changes: PropertyChanges, gravity: Sequence[float]) -> PropertyChanges:
    """Return the changes with another gravity, m/s2, shape (3,).

    Raises:
        RequestError: it is not a gravity.
    """
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
    return changes.with_gravity((x, y, z))


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
