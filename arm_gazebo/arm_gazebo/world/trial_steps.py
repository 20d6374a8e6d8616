"""Steps a model a few times, to find out whether it can be simulated."""

import mujoco
import numpy as np

STEPS = 5


def can_be_simulated(model: mujoco.MjModel) -> bool:
    """Return whether the numbers of a compiled model are finite, and stay so in a few steps."""
    data = mujoco.MjData(model)
    mujoco.mj_step(model, data, STEPS)
    numbers = (model.body_mass, model.body_inertia, model.geom_rbound, data.xpos, data.geom_xpos)
    # MuJoCo resets itself when a number is no longer finite.
    was_reset = data.time < (STEPS - 0.5) * model.opt.timestep
    return not was_reset and all(np.isfinite(values).all() for values in numbers)
