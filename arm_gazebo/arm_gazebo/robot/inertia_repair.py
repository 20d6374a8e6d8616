"""Inertias that a rigid body can have, made from those that a URDF gives."""

from dataclasses import dataclass

import mujoco
import numpy as np
from numpy.typing import NDArray

from arm_description.robot import Inertial
from arm_description.transforms import rotation_from_rpy

Array = NDArray[np.float64]

SMALLEST_MASS_KG = 1e-3
SMALLEST_INERTIA = 1e-14
"""Below this, in kg m2, an inertia is taken for missing; MuJoCo takes none below 1e-15."""
DEFAULT_INERTIA = 1e-6
HOLLOW_KG_M3 = 300.0
"""Mass of a robot's link over the volume of the box around it: between 200 and 500 in practice."""
LARGEST_GYRATION_M2 = 4.0
"""Inertia over mass that few links have: a mesh in millimetres taken for metres has it."""
LARGEST_MOMENT = 1e300
"""Larger ones, in kg m2, are nonsense whose sums no float can hold."""
ROUNDING = 1e-3
"""How far decimals in a URDF may break the triangle inequality without a word."""
NUMERICALLY_NONE = 1e-12
"""A moment of less than this share of the largest is 0 but for the arithmetic."""


@dataclass(frozen=True, slots=True)
class PrincipalInertia:
    """A body's mass and its inertia about its principal axes.

    Attributes:
        mass: kg.
        position: centre of mass in the link's frame, shape (3,).
        quaternion: orientation (w, x, y, z) of the principal axes in the link's frame.
        moments: kg m2 about the principal axes, shape (3,).
        remarks: what was repaired or is doubtful, one sentence each.
    """

    mass: float
    position: NDArray[np.float64]
    quaternion: NDArray[np.float64]
    moments: NDArray[np.float64]
    remarks: tuple[str, ...] = ()


def missing_inertia(box: Array | None) -> PrincipalInertia:
    """Return what a moving link that is given no mass gets.

    Args:
        box: lowest and highest corner of the link's shapes, shape (2, 3), taken for a hollow
            body; None for a mere frame, which gets too little to be felt.
    """
    upright = np.array([1.0, 0.0, 0.0, 0.0])
    if box is None:
        return PrincipalInertia(SMALLEST_MASS_KG, np.zeros(3), upright, np.full(3, DEFAULT_INERTIA))
    size = box[1] - box[0]
    mass = max(HOLLOW_KG_M3 * float(size.prod()), SMALLEST_MASS_KG)
    moments = np.maximum(_box_moments(mass, size), DEFAULT_INERTIA)
    return PrincipalInertia(mass, box.mean(axis=0), upright, moments)


def repair_inertia(inertial: Inertial, box: NDArray[np.float64] | None = None) -> PrincipalInertia:
    """Return the inertia of a link, repaired where no rigid body can have it.

    Args:
        inertial: as in the URDF.
        box: lowest and highest corner of the link's shapes in the link's frame, shape (2, 3);
            None where it has none. It replaces an inertia that its size cannot have.
    """
    remarks: list[str] = []
    mass = inertial.mass
    if mass <= 0:
        remarks.append(f"a mass of {mass:g} kg is not above 0; {SMALLEST_MASS_KG:g} kg is used")
        mass = SMALLEST_MASS_KG
    ixx, ixy, ixz, iyy, iyz, izz = inertial.inertia
    moments, axes = np.linalg.eigh(np.array([[ixx, ixy, ixz], [ixy, iyy, iyz], [ixz, iyz, izz]]))
    moments = np.clip(moments, -LARGEST_MOMENT, LARGEST_MOMENT)
    axes = rotation_from_rpy(inertial.origin.rpy) @ axes
    large = moments[2] > LARGEST_GYRATION_M2 * mass
    if large and not _fits(mass, moments[2], np.array(inertial.origin.xyz), box):
        moments, axes = _implausible(mass, moments, axes, box, remarks)
    moments = _physical(moments, remarks)
    if np.linalg.det(axes) < 0:
        axes = axes * (1.0, 1.0, -1.0)
    quaternion = np.zeros(4)
    mujoco.mju_mat2Quat(quaternion, np.ascontiguousarray(axes).ravel())
    return PrincipalInertia(
        mass, np.array(inertial.origin.xyz), quaternion, moments, tuple(remarks)
    )


def _fits(mass: float, moment: float, centre: Array, box: Array | None) -> bool:
    """Return whether a mass with that centre can have the moment and lie within the box."""
    if box is None:
        return False
    reach = np.sort(np.abs(box - centre).max(axis=0))
    return moment <= mass * (reach[1] ** 2 + reach[2] ** 2)


def _implausible(
    mass: float, moments: Array, axes: Array, box: Array | None, remarks: list[str]
) -> tuple[Array, Array]:
    """Replace, or only remark on, an inertia that wants the mass metres away from its centre."""
    finding = (
        f"an inertia of {moments[2]:.3g} kg m2 on {mass:g} kg looks like a mesh in millimetres "
        "taken for metres"
    )
    if box is None:
        remarks.append(f"{finding}; it is used as it is")
        return moments, axes
    moments = _box_moments(mass, box[1] - box[0])
    remarks.append(f"{finding}; that of its bounding box is used, up to {moments.max():.3g} kg m2")
    return moments, np.eye(3)


def _box_moments(mass: float, size: Array) -> Array:
    x, y, z = size**2
    return mass / 12 * np.array([y + z, x + z, x + y])


def _physical(moments: Array, remarks: list[str]) -> Array:
    """Return moments above 0, none of which exceeds the sum of the other two."""
    if moments.max() < SMALLEST_INERTIA:
        remarks.append(f"it has no inertia; {DEFAULT_INERTIA:g} kg m2 is used")
        return np.full(3, DEFAULT_INERTIA)
    largest = moments.max()
    if moments.min() < -ROUNDING * largest:
        remarks.append(f"its inertia has a principal moment below 0 ({moments.min():.3g} kg m2)")
    # A rod has very little about its axis, and rolls accordingly; only what is missing is made up.
    there = np.where(moments > NUMERICALLY_NONE * largest, moments, ROUNDING * largest)
    moments = np.maximum(there, SMALLEST_INERTIA)
    largest = moments.max()
    others = moments.sum() - largest
    # The margin keeps rounding from failing MuJoCo's own check.
    missing = (1 + 1e-9) * largest - others
    if missing > ROUNDING * largest:
        remarks.append(
            f"its inertia is impossible: {largest:.4g} kg m2 about one principal axis is more "
            "than about the other two together; those were raised"
        )
    if missing > 0:
        # In proportion: rounding on a rod's length is many times what it has about its axis.
        moments = np.where(moments == largest, moments, moments * (1 + missing / others))
    return moments
