"""Skip collision detection while nothing can touch; it is half the cost of a free arm."""

import math

import mujoco
import numpy as np
from numpy.typing import NDArray

from arm_node.frozen import frozen
from arm_node.index_slice import as_slice

CHECK_EVERY_S = 0.01
FASTEST_M_S = 5.0
"""A body slower than this cannot reach the floor unnoticed between two checks."""
FALLING_M_S = 4.0
"""A body in free fall at this speed may exceed `FASTEST_M_S` before the next check."""
CONTACT = mujoco.mjtDisableBit.mjDSBL_CONTACT
PLANE = mujoco.mjtGeom.mjGEOM_PLANE


@frozen
class Clearance:
    """How far above the floor the shapes must be so that none reaches it before the next check.

    Attributes:
        useful: whether moving shapes can touch nothing but a level floor.
        moving: the shapes that can move and touch something.
        needed: the heights of their origins that suffice, shape (moving,).
        free: vertical degrees of freedom of the bodies that can fall.
        ticks: control periods from one check to the next.
    """

    useful: bool
    moving: NDArray[np.intp]
    needed: NDArray[np.float64]
    free: NDArray[np.intp]
    ticks: int


def floor_clearance(model: mujoco.MjModel, data: mujoco.MjData, period_s: float) -> Clearance:
    """Return the clearance of a model above its floor in a state with valid geom positions."""
    ticks = max(1, round(CHECK_EVERY_S / period_s))
    moving = _moving_geoms(model)
    # Forces begin at the sum of both margins.
    way = FASTEST_M_S * ticks * period_s + model.geom_margin[moving]
    return Clearance(
        useful=not model.opt.disableflags & int(CONTACT) and _only_floor_below(model, data),
        moving=moving,
        needed=model.geom_rbound[moving] + _floor_height(model, data) + way,
        free=model.jnt_dofadr[model.jnt_type == mujoco.mjtJoint.mjJNT_FREE] + 2,
        ticks=ticks,
    )


class ContactGate:
    """Switches MuJoCo's collision detection off while everything is well above a bare floor.

    It stays on in a world with other shapes to touch, or with parts that touch each other. The geom
    positions in `data` are valid, and `period_s` is the time between two calls of `update`.
    """

    def __init__(self, model: mujoco.MjModel, data: mujoco.MjData, period_s: float) -> None:
        self._model = model
        self._off = model.opt.disableflags | int(CONTACT)
        self._on = model.opt.disableflags & ~int(CONTACT)
        self._is_off = bool(model.opt.disableflags & int(CONTACT))
        clearance = floor_clearance(model, data, period_s)
        self._useful, self._ticks = clearance.useful, clearance.ticks
        self._until_check = 0
        self._heights = data.geom_xpos[:, 2]
        self._moving = as_slice(clearance.moving)
        self._needed = clearance.needed
        self._clear = np.empty(len(clearance.moving), dtype=bool)
        self._can_fall = len(clearance.free) > 0
        self._velocities = data.qvel
        self._free = as_slice(clearance.free)

    def save_state(self) -> tuple[int, bool]:
        """Return when the next check is due, and whether collision detection is off."""
        return self._until_check, self._is_off

    def load_state(self, state: tuple[int, bool]) -> None:
        """Continue from a saved state; switch collision detection as it was then."""
        self._until_check, self._is_off = state
        if self._useful:
            self._model.opt.disableflags = self._off if self._is_off else self._on

    def update(self) -> None:
        """Check whether anything is near the floor; called once in each control period."""
        if not self._useful:
            return
        self._until_check -= 1
        if self._until_check < 0:
            self._until_check = self._ticks - 1
            np.greater(self._heights[self._moving], self._needed, self._clear)
            # Few and small operations: after 10 ms of sleep the caches are cold, and a reduction or
            # a read of the options costs half as much as the whole physics step.
            all_clear = False not in self._clear.tobytes()
            if all_clear and self._can_fall:
                all_clear = min(self._velocities[self._free].tolist()) > -FALLING_M_S
            if all_clear is not self._is_off:
                self._is_off = all_clear
                self._model.opt.disableflags = self._off if all_clear else self._on


def _touchable(model: mujoco.MjModel) -> np.ndarray:
    return np.flatnonzero(model.geom_contype | model.geom_conaffinity)


def _moving_geoms(model: mujoco.MjModel) -> np.ndarray:
    """Return the geoms that can move and touch something."""
    geoms = _touchable(model)
    return geoms[_can_move(model, geoms)]


def _can_move(model: mujoco.MjModel, geoms: np.ndarray) -> np.ndarray:
    return model.body_weldid[model.geom_bodyid[geoms]] > 0


def _floor_geoms(model: mujoco.MjModel) -> np.ndarray:
    """Return the static geoms that a moving geom could touch."""
    moving = _moving_geoms(model)
    types = int(np.bitwise_or.reduce(model.geom_contype[moving], initial=0))
    affinities = int(np.bitwise_or.reduce(model.geom_conaffinity[moving], initial=0))
    geoms = _touchable(model)
    geoms = geoms[~_can_move(model, geoms)]
    touch = (model.geom_contype[geoms] & affinities) | (model.geom_conaffinity[geoms] & types)
    return geoms[touch != 0]


def _floor_height(model: mujoco.MjModel, data: mujoco.MjData) -> float:
    """Return the height up to which the floor pushes things away."""
    floor = _floor_geoms(model)
    return float((data.geom_xpos[floor, 2] + model.geom_margin[floor]).max(initial=-math.inf))


def _only_floor_below(model: mujoco.MjModel, data: mujoco.MjData) -> bool:
    """Return whether moving geoms can touch nothing but a level floor."""
    moving, floor = _moving_geoms(model), _floor_geoms(model)
    types = model.geom_contype[moving][:, None] & model.geom_conaffinity[moving][None]
    if types.any() or model.npair or model.nflex or model.nmocap:
        return False
    level = data.geom_xmat[floor, 8] > 1.0 - 1e-9
    return bool((model.geom_type[floor] == PLANE).all() and level.all())
