"""Leave shapes that are only drawn out of MuJoCo's steps: a tenth of a step among other things.

MuJoCo moves every shape of a moving body in each step, and bounds a body by all of its shapes, also
by those that touch nothing.
"""

import mujoco
import numpy as np
from numpy.typing import NDArray

WRAPPED = (mujoco.mjtWrap.mjWRAP_SPHERE, mujoco.mjtWrap.mjWRAP_CYLINDER)


class SteppedShapes:
    """Hides the shapes of a model that no step needs. Loop thread only.

    Contacts stay the same, bit for bit; MuJoCo looks for what is near in smaller boxes. While it
    steps, hidden shapes keep their poses. The model's lists of the bodies' shapes are changed.
    """

    def __init__(self, model: mujoco.MjModel) -> None:
        first, count = model.body_geomadr, model.body_geomnum
        needed_first, needed_count = first.copy(), count.copy()
        needed = _needed(model)
        for body in range(model.nbody):
            shapes = np.flatnonzero(needed[first[body] : first[body] + count[body]])
            # MuJoCo knows the shapes of a body by the first one and their number.
            needed_first[body] += shapes[0] if len(shapes) else 0
            needed_count[body] = shapes[-1] - shapes[0] + 1 if len(shapes) else 0
        # Views, which are written four times in each control period: twice as fast as NumPy.
        self._first, self._count = memoryview(first), memoryview(count)
        self._every = memoryview(first.copy()), memoryview(count.copy())
        self._needed = memoryview(needed_first), memoryview(needed_count)

    def hide(self) -> None:
        """Hide the shapes until `show`, which must follow within the same control period."""
        self._first[:], self._count[:] = self._needed

    def show(self) -> None:
        """Show all shapes, for everything but steps."""
        self._first[:], self._count[:] = self._every


def _needed(model: mujoco.MjModel) -> NDArray[np.bool_]:
    """Return which shapes a step needs, shape (ngeom,)."""
    needed = (model.geom_contype != 0) | (model.geom_conaffinity != 0)
    # Shapes that touch, are pushed by a fluid, or guide a tendon, whatever their masks.
    needed[model.pair_geom1] = needed[model.pair_geom2] = True
    needed |= model.geom_fluid[:, 0] != 0.0
    needed[model.wrap_objid[np.isin(model.wrap_type, [int(one) for one in WRAPPED])]] = True
    return needed
