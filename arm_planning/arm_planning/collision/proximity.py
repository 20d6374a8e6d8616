"""How near bodies are to each other, where they are near."""

from collections.abc import Mapping

import mujoco
import numpy as np
from numpy.typing import NDArray

from arm_planning.collision.contact import BodyKind
from arm_planning.collision.model import CollisionModel

Array = NDArray[np.float64]


class Proximity:
    """Finds what is near in a state.

    Bodies that do not move against each other are left out. Not thread-safe.

    Args:
        model: the robot and its surroundings.
    """

    def __init__(self, model: CollisionModel) -> None:
        self._posed = model.posed
        self._model, self._data = self._posed.model, self._posed.data
        # MuJoCo adds the margins of two geoms, so those of what is fixed stay 0.
        self._moving_bodies = self._model.body_weldid > 0
        self._moving_geoms = self._moving_bodies[self._model.geom_bodyid]
        self._bits = (
            (self._model.body_contype, self._model.geom_contype),
            (self._model.body_conaffinity, self._model.geom_conaffinity),
        )

    def near(self, q: Array, within_m: float) -> Mapping[int, float]:
        """Return the distance of each pair of bodies that is near, in m; negative in contact.

        Args:
            q: the positions of the model's joints, (n,).
            within_m: the largest distance.

        Raises:
            PlanningError: a position is not finite.
        """
        self._posed.place(q)
        self._set_margins(within_m)
        # What never touches may still be near.
        left_out = [of_bodies.copy() for of_bodies, _ in self._bits]
        for of_bodies, of_geoms in self._bits:
            np.bitwise_or.at(of_bodies, self._model.geom_bodyid, of_geoms)
        try:
            mujoco.mj_collision(self._model, self._data)
        finally:
            self._set_margins(0.0)
            for (of_bodies, _), bits in zip(self._bits, left_out, strict=True):
                of_bodies[:] = bits
        if not self._data.ncon:
            return {}
        found = self._data.contact
        bodies = np.sort(self._model.geom_bodyid[found.geom], axis=1)
        pairs, distances = bodies @ (self._model.nbody, 1), found.dist
        # The nearest one of a pair comes last, and stays.
        order = np.argsort(-distances)
        nearest = dict(zip(pairs[order].tolist(), distances[order].tolist(), strict=True))
        return {pair: distance for pair, distance in nearest.items() if distance < within_m}

    def names(self, pair: int) -> tuple[str, str]:
        """Return the names of a pair's bodies, an object of the world last."""
        first, second = (self._posed.bodies[body] for body in divmod(pair, self._model.nbody))
        assert first is not None
        assert second is not None
        if first.kind is BodyKind.WORLD_OBJECT:
            first, second = second, first
        return first.name, second.name

    def is_with_world(self, pair: int) -> bool:
        """Return whether one of a pair's bodies is an object of the world."""
        bodies = (self._posed.bodies[body] for body in divmod(pair, self._model.nbody))
        return any(body is not None and body.kind is BodyKind.WORLD_OBJECT for body in bodies)

    def _set_margins(self, margin_m: float) -> None:
        model = self._model
        model.geom_margin[self._moving_geoms] = margin_m
        model.body_margin[self._moving_bodies] = margin_m
        model.pair_margin[:] = margin_m
