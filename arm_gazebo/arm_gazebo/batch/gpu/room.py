"""How many contacts and constraints copies have room for in MuJoCo Warp, decided at the start."""

from dataclasses import dataclass

import mujoco
import mujoco_warp
import numpy as np
from numpy.typing import NDArray

from arm_gazebo.errors import BatchError

LEAST_CONTACTS = 48
CONTACTS = 32
CONTACTS_PER_TREE = 12
"""A box on the floor has 4 contacts, and as many with the fingers and with the box beside it."""
CONTACTS_OF_SURFACE = 256
"""More contacts where there are height fields or soft bodies."""
EQUALITY_ROWS = {
    mujoco.mjtEq.mjEQ_CONNECT: 3,
    mujoco.mjtEq.mjEQ_WELD: 6,
}
"""Rows of the equality constraints; all others have one."""


@dataclass(frozen=True, slots=True)
class Room:
    """Room for one copy.

    Attributes:
        contacts: contacts; a copy may use the room of others.
        rows: rows of all constraints: equalities, friction, limits and contacts.
    """

    contacts: int
    rows: int


def room_of(model: mujoco.MjModel) -> Room:
    """Return the room for copies of a model."""
    contacts = max(LEAST_CONTACTS, CONTACTS + CONTACTS_PER_TREE * model.ntree)
    if model.nhfield or model.nflex:
        contacts += CONTACTS_OF_SURFACE
    dimension = int(max([1, *model.geom_condim, *model.pair_dim]))
    if model.opt.cone == mujoco.mjtCone.mjCONE_PYRAMIDAL and dimension > 1:
        dimension = 2 * (dimension - 1)
    rows = sum(EQUALITY_ROWS.get(kind, 1) for kind in model.eq_type.tolist())
    rows += int((model.dof_frictionloss > 0.0).sum() + (model.tendon_frictionloss > 0.0).sum())
    # A joint or tendon may be at both of its limits.
    rows += 2 * int(model.jnt_limited.sum() + model.tendon_limited.sum())
    return Room(contacts, rows + dimension * contacts)


def check_overflow(overflow: NDArray[np.int32], room: Room) -> None:
    """Check that the room sufficed.

    Args:
        overflow: MuJoCo Warp's flags of each copy, shape (copies,).
        room: the room.

    Raises:
        BatchError: it did not, so that contacts are missing in these copies.
    """
    kinds = mujoco_warp.OverflowType
    # The others say that a solver stopped at its last iteration, which does not disturb MuJoCo.
    missing = kinds.NEFC | kinds.NJMAX_NNZ | kinds.BROADPHASE | kinds.NARROWPHASE
    missing |= kinds.CCD | kinds.HFIELD
    count = int(((overflow & int(missing)) != 0).sum())
    if count:
        raise BatchError(
            f"{count} copies have more contacts than there is room for on the device: "
            f"{room.contacts} contacts and {room.rows} rows of constraints for each; "
            "device='host' has no such limit"
        )
