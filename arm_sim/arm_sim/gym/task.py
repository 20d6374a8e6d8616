"""The task of a policy: observations, reward, end and start as functions of a scene.

The functions work on arrays whose last axis is the joint or the coordinate. So the same task runs
in one environment, where there is no other axis, and in a batch, where the first one is the copy.
"""

from collections.abc import Callable, Mapping
from dataclasses import dataclass, field
from typing import Any, Protocol

import numpy as np
from numpy.typing import NDArray

Array = NDArray[np.float64]
Flags = NDArray[np.bool_]


class Scene(Protocol):
    """The present state of the robot in an episode; leading axes, if any, are the copies."""

    @property
    def joints(self) -> tuple[str, ...]:
        """Names of the commanded joints."""
        ...

    @property
    def lower(self) -> Array:
        """Lowest positions of these joints in rad or m, -inf for none, shape (n,)."""
        ...

    @property
    def upper(self) -> Array:
        """Highest positions of these joints, inf for none, shape (n,)."""
        ...

    @property
    def goal(self) -> Mapping[str, Array]:
        """What the task's `start` returned for this episode, by name, shape (..., m)."""
        ...

    @property
    def position(self) -> Array:
        """Positions of the commanded joints in rad or m, shape (..., n)."""
        ...

    @property
    def velocity(self) -> Array:
        """Their velocities in rad/s or m/s, shape (..., n)."""
        ...

    @property
    def command(self) -> Array:
        """Their last commands in the unit of the actions, shape (..., n)."""
        ...

    def point(self, link: str) -> Array:
        """Return the origin of a link, or of a thing in the world, in m, shape (..., 3).

        Raises:
            UnknownNameError: there is no such link.
        """
        ...

    def point_at(self, link: str, positions: Array) -> Array:
        """Return where a link would be, shape (3,), with the joints at positions, shape (n,)."""
        ...


@dataclass(frozen=True, slots=True)
class Observation:
    """One observation; values beyond the bounds are clipped.

    Attributes:
        of: returns it, shape (..., m).
        low: lower bound.
        high: upper bound.
    """

    of: Callable[[Scene], Array]
    low: float = -100.0
    high: float = 100.0


JOINT_POSITIONS = Observation(lambda scene: scene.position, -4.0 * np.pi, 4.0 * np.pi)
JOINT_VELOCITIES = Observation(lambda scene: scene.velocity, -50.0, 50.0)
PROPRIOCEPTION: Mapping[str, Observation] = {
    "position": JOINT_POSITIONS,
    "velocity": JOINT_VELOCITIES,
}
"""The positions and velocities of the joints, in rad, m and s."""


def _nothing(scene: Scene) -> Any:
    return np.zeros(scene.position.shape[:-1])


def _never(scene: Scene) -> Any:
    return np.zeros(scene.position.shape[:-1], dtype=bool)


def _no_goal(scene: Scene, random: np.random.Generator) -> Mapping[str, Array]:
    return {}


@dataclass(frozen=True, slots=True)
class Task:
    """Observations, reward, end and start of episodes.

    Attributes:
        observations: by name.
        reward: returns the reward of the state after an action, shape (...).
        terminated: returns whether the episode is over, shape (...).
        succeeded: returns whether the task is done, which infos contain as `is_success`.
        start: draws the values that differ from episode to episode, by name, each of shape (m,). It
            is called once for each copy, so it can use only the parts of the scene that do not
            depend on the state.
    """

    observations: Mapping[str, Observation] = field(default_factory=lambda: dict(PROPRIOCEPTION))
    reward: Callable[[Scene], Array] = _nothing
    terminated: Callable[[Scene], Flags] = _never
    succeeded: Callable[[Scene], Flags] = _never
    start: Callable[[Scene, np.random.Generator], Mapping[str, Array]] = _no_goal

    def observe(self, scene: Scene) -> dict[str, NDArray[np.float32]]:
        """Return the observations of a scene, as new arrays."""
        return {
            # Not np.clip, which takes twice as long.
            name: np.minimum(np.maximum(one.of(scene), one.low), one.high).astype(np.float32)
            for name, one in self.observations.items()
        }
