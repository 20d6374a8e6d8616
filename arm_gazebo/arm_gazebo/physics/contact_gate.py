"""Leaves collision detection out while nothing can touch: it is half of the cost of a free arm."""

import math

import mujoco
import numpy as np

from arm_gazebo.index_slice import as_slice

CHECK_EVERY_S = 0.01
FASTEST_M_S = 5.0
"""What moves slower than this cannot reach the floor unseen between two checks."""
FALLING_M_S = 4.0
"""What falls freely faster than this may be faster than that before the next check."""
CONTACT = mujoco.mjtDisableBit.mjDSBL_CONTACT
PLANE = mujoco.mjtGeom.mjGEOM_PLANE


class ContactGate:
    """Switches MuJoCo's collision detection off while all that moves is well above a bare floor.

    In a world with other things to touch, or with parts that touch each other, it stays on.

    Args:
        model: its option flags are switched.
        data: positions of the geoms are read.
        period_s: time between two calls of `update`.
    """

    def __init__(self, model: mujoco.MjModel, data: mujoco.MjData, period_s: float) -> None:
        self._model = model
        self._off = model.opt.disableflags | int(CONTACT)
        self._on = model.opt.disableflags & ~int(CONTACT)
        self._is_off = bool(model.opt.disableflags & int(CONTACT))
        self._useful = not self._is_off and _only_floor_below(model, data)
        self._ticks = max(1, round(CHECK_EVERY_S / period_s))
        self._until_check = 0
        moving = _moving_geoms(model)
        margin = FASTEST_M_S * self._ticks * period_s
        self._heights = data.geom_xpos[:, 2]
        self._moving = as_slice(moving)
        self._needed = model.geom_rbound[moving] + _floor_height(model, data) + margin
        self._clear = np.empty(len(moving), dtype=bool)
        free = model.jnt_dofadr[model.jnt_type == mujoco.mjtJoint.mjJNT_FREE]
        self._can_fall = len(free) > 0
        self._upwards = data.qvel[2:]
        self._free = as_slice(free)

    def update(self) -> None:
        """Look whether anything is near the floor; called once in each control period."""
        if not self._useful:
            return
        self._until_check -= 1
        if self._until_check < 0:
            self._until_check = self._ticks - 1
            np.greater(self._heights[self._moving], self._needed, self._clear)
            # Few and small steps: after 10 ms of sleep all that is called comes from afar, and a
            # reduction or a look at the options costs half as much as all of the physics.
            all_clear = False not in self._clear.tobytes()
            if all_clear and self._can_fall:
                all_clear = min(self._upwards[self._free].tolist()) > -FALLING_M_S
            if all_clear is not self._is_off:
                self._is_off = all_clear
                self._model.opt.disableflags = self._off if all_clear else self._on


def _touchable(model: mujoco.MjModel) -> np.ndarray:
    return np.flatnonzero(model.geom_contype | model.geom_conaffinity)


def _moving_geoms(model: mujoco.MjModel) -> np.ndarray:
    """Return the geoms that can move and touch something."""
    geoms = _touchable(model)
    return geoms[model.body_weldid[model.geom_bodyid[geoms]] > 0]


def _floor_geoms(model: mujoco.MjModel) -> np.ndarray:
    """Return the geoms that stand still and that something moving could touch."""
    moving = _moving_geoms(model)
    types = int(np.bitwise_or.reduce(model.geom_contype[moving], initial=0))
    affinities = int(np.bitwise_or.reduce(model.geom_conaffinity[moving], initial=0))
    geoms = np.setdiff1d(_touchable(model), moving)
    touch = (model.geom_contype[geoms] & affinities) | (model.geom_conaffinity[geoms] & types)
    return geoms[touch != 0]


def _floor_height(model: mujoco.MjModel, data: mujoco.MjData) -> float:
    return float(data.geom_xpos[_floor_geoms(model), 2].max(initial=-math.inf))


def _only_floor_below(model: mujoco.MjModel, data: mujoco.MjData) -> bool:
    """Return whether a level floor is all that anything moving can touch."""
    moving, floor = _moving_geoms(model), _floor_geoms(model)
    types = model.geom_contype[moving][:, None] & model.geom_conaffinity[moving][None]
    if types.any() or model.npair or model.nflex or model.nmocap:
        return False
    level = data.geom_xmat[floor, 8] > 1.0 - 1e-9
    return bool((model.geom_type[floor] == PLANE).all() and level.all())
