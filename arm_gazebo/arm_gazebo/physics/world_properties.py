"""Gravity, masses and friction that a user changes while the simulation runs.

The model's own values are kept, and each change starts from them: a run with the same changes has
the same bits, whatever was set before.
"""

from collections.abc import Collection, Mapping
from dataclasses import field, replace

import mujoco
import numpy as np
from numpy.typing import NDArray

from arm_gazebo.robot.link_geometry import friction_priority
from arm_node.frozen import frozen

Gravity = tuple[float, float, float]


@frozen
class PropertyChanges:
    """What differs from the world's own properties, by default nothing. SI units.

    A thing is known by the name of its top-level body.

    Attributes:
        gravity: acceleration in the world, m/s2; None for the world's own.
        masses: of things with all that is attached to them, kg.
        frictions: coefficients of sliding friction of all shapes of things.
    """

    gravity: Gravity | None = None
    masses: Mapping[str, float] = field(default_factory=dict)
    frictions: Mapping[str, float] = field(default_factory=dict)

    def with_gravity(self, gravity: Gravity) -> "PropertyChanges":
        """Return these changes with another gravity."""
        return replace(self, gravity=gravity)

    def with_mass(self, root: str, mass_kg: float) -> "PropertyChanges":
        """Return these changes with another mass of a thing."""
        return replace(self, masses={**self.masses, root: mass_kg})

    def with_friction(self, root: str, friction: float) -> "PropertyChanges":
        """Return these changes with another friction of a thing."""
        return replace(self, frictions={**self.frictions, root: friction})

    def carried_to(self, model: mujoco.MjModel, roots: Collection[str]) -> "PropertyChanges":
        """Return the changes that continue in another model.

        `roots` are the top-level bodies that continue; gravity does if the world is one of them.
        """
        world, names = model.body(0).name, _top_level(model).intersection(roots)
        return PropertyChanges(
            self.gravity if world in roots else None,
            {root: mass for root, mass in self.masses.items() if root in names},
            {root: value for root, value in self.frictions.items() if root in names},
        )


UNCHANGED = PropertyChanges()
"""The properties of the world as it was built."""


class OwnProperties:
    """The properties of a model as it was built."""

    def __init__(self, model: mujoco.MjModel) -> None:
        """Copy them from a model in which nothing was changed."""
        self._gravity = model.opt.gravity.copy()
        self._masses, self._inertias = model.body_mass.copy(), model.body_inertia.copy()
        self._frictions, self._priorities = model.geom_friction.copy(), model.geom_priority.copy()

    def change(self, model: mujoco.MjModel, changes: PropertyChanges) -> None:
        """Give the model its own properties with these changes.

        A thing becomes evenly denser or lighter. What MuJoCo derives from masses is not renewed.
        """
        model.opt.gravity[:] = self._gravity if changes.gravity is None else changes.gravity
        model.body_mass[:], model.body_inertia[:] = self._masses, self._inertias
        model.geom_friction[:], model.geom_priority[:] = self._frictions, self._priorities
        for root, mass_kg in changes.masses.items():
            bodies = bodies_of(model, root)
            own_kg = self._masses[bodies].sum()
            # A thing of one body has the wanted mass to the last bit.
            model.body_mass[bodies] = mass_kg * (self._masses[bodies] / own_kg)
            model.body_inertia[bodies] *= mass_kg / own_kg
        for root, friction in changes.frictions.items():
            shapes = shapes_of(model, root)
            model.geom_friction[shapes, 0] = friction
            model.geom_priority[shapes] = friction_priority(friction)


def bodies_of(model: mujoco.MjModel, root: str) -> NDArray[np.intp]:
    """Return the indices of a top-level body and of all that is attached to it."""
    return np.flatnonzero(model.body_rootid == model.body(root).id)


def shapes_of(model: mujoco.MjModel, root: str) -> NDArray[np.intp]:
    """Return the indices of all shapes of a top-level body and of what is attached to it."""
    return np.flatnonzero(model.body_rootid[model.geom_bodyid] == model.body(root).id)


def _top_level(model: mujoco.MjModel) -> set[str]:
    return {model.body(body).name for body in np.flatnonzero(model.body_parentid == 0).tolist()}
