"""Looks at a state with all that MuJoCo derives from it, without touching the simulation."""

import mujoco

EVERYTHING = mujoco.mjtState.mjSTATE_INTEGRATION
WITHOUT_SENSORS = int(mujoco.mjtDisableBit.mjDSBL_SENSOR)
WITH_SLEEP = int(mujoco.mjtEnableBit.mjENBL_SLEEP)


class StateProbe:
    """A second set of MuJoCo's arrays, brought to the present state when somebody asks.

    After a step MuJoCo's accelerations, contacts and sensors are those of the state before it.
    Bringing the simulation's own arrays up to date would change its next step by a rounding
    error, so that a run depended on who listens. Loop thread.

    Attributes:
        number: of the present state, counted from 0.
    """

    def __init__(self) -> None:
        self.number = 0
        self._looked_at = -1
        self._model: mujoco.MjModel | None = None
        self._data: mujoco.MjData | None = None

    def expire(self) -> None:
        """Note that there is a new state."""
        self.number += 1

    def look(self, model: mujoco.MjModel, data: mujoco.MjData) -> mujoco.MjData:
        """Return the present state; valid until the next one, and not to be written to.

        Args:
            model: may be another one than before.
            data: the simulation's.
        """
        if self._data is None or self._model is not model:
            self._model, self._data = model, mujoco.MjData(model)
            self._looked_at = -1
        if self._looked_at != self.number:
            self._looked_at = self.number
            mujoco.mj_copyState(model, data, self._data, EVERYTHING)
            self._evaluate(model, self._data)
        return self._data

    def _evaluate(self, model: mujoco.MjModel, data: mujoco.MjData) -> None:
        without, having = model.opt.disableflags, model.opt.enableflags
        model.opt.disableflags = without & ~WITHOUT_SENSORS
        # What sleeps is not computed anew, and may have been elsewhere at the last look.
        model.opt.enableflags = having & ~WITH_SLEEP
        mujoco.mj_forward(model, data)
        model.opt.disableflags, model.opt.enableflags = without, having
