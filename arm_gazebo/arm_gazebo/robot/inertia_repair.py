"""Repair the inertias of a URDF so that a rigid body can have them."""

import math

import mujoco
import numpy as np
from numpy.typing import NDArray

from arm_description.transforms import rotation_from_rpy
from arm_description.urdf.robot import Inertial
from arm_node.frozen import frozen

Array = NDArray[np.float64]

MIN_MASS_KG = 1e-3
MIN_INERTIA = 1e-14
"""An inertia below this, in kg m2, counts as missing; MuJoCo accepts none below 1e-15."""
DEFAULT_INERTIA = 1e-6
HOLLOW_KG_M3 = 300.0
"""Mass of a link divided by the volume of its bounding box; 200 to 500 in practice."""
MAX_GYRATION_M2 = 4.0
"""Ratio of inertia to mass above which the inertia is doubted: the mass would be 2 m away."""
MILLIMETRES_M = 10.0
"""Radius of gyration above which it probably was a mesh in millimetres."""
MAX_MOMENT = 1e300
"""Limit in kg m2 that keeps sums of absurd moments from overflowing."""
ROUNDING = 1e-3
"""How far rounded decimals in a URDF may violate the triangle inequality without a warning."""
RELATIVE_ZERO = 1e-12
"""A moment below this fraction of the largest one is 0 apart from rounding."""


@frozen
class PrincipalInertia:
    """A body's mass and its inertia about its principal axes.

    Attributes:
        mass: kg.
        position: centre of mass in the link's frame, shape (3,).
        quaternion: orientation (w, x, y, z) of the principal axes in the link's frame.
        moments: kg m2 about the principal axes, shape (3,).
        remarks: one sentence for each repair or doubt.
    """

    mass: float
    position: NDArray[np.float64]
    quaternion: NDArray[np.float64]
    moments: NDArray[np.float64]
    remarks: tuple[str, ...] = ()


def missing_inertia(box: Array | None) -> PrincipalInertia:
    """Return an inertia for a moving link without a mass.

    Args:
        box: lowest and highest corner of the link's shapes, shape (2, 3), treated as a hollow
            body; None for a link without shapes, which gets a negligible mass.
    """
    upright = np.array([1.0, 0.0, 0.0, 0.0])
    if box is None:
        return PrincipalInertia(MIN_MASS_KG, np.zeros(3), upright, np.full(3, DEFAULT_INERTIA))
    size = box[1] - box[0]
    mass = max(HOLLOW_KG_M3 * float(size.prod()), MIN_MASS_KG)
    moments = np.maximum(_box_moments(mass, size), DEFAULT_INERTIA)
    return PrincipalInertia(mass, box.mean(axis=0), upright, moments)


def repair_inertia(inertial: Inertial, box: NDArray[np.float64] | None = None) -> PrincipalInertia:
    """Return the inertia of a link, repaired if no rigid body can have it.

    Args:
        inertial: the inertia in the URDF.
        box: lowest and highest corner of the link's shapes in the link's frame, shape (2, 3);
            None without shapes. Its inertia replaces one that is impossible for that size.
    """
    remarks: list[str] = []
    mass = inertial.mass
    if mass <= 0:
        remarks.append(f"a mass of {mass:g} kg is not above 0; {MIN_MASS_KG:g} kg is used")
        mass = MIN_MASS_KG
    ixx, ixy, ixz, iyy, iyz, izz = inertial.inertia
    moments, axes = np.linalg.eigh(np.array([[ixx, ixy, ixz], [ixy, iyy, iyz], [ixz, iyz, izz]]))
    moments = np.clip(moments, -MAX_MOMENT, MAX_MOMENT)
    axes = rotation_from_rpy(inertial.origin.rpy) @ axes
    large = moments[2] > MAX_GYRATION_M2 * mass
    if large and not _fits(mass, moments[2], np.array(inertial.origin.xyz), box):
        moments, axes = _replaced_implausible(mass, moments, axes, box, remarks)
    moments = _physical(moments, remarks)
    if np.linalg.det(axes) < 0:
        axes = axes * (1.0, 1.0, -1.0)
    quaternion = np.zeros(4)
    mujoco.mju_mat2Quat(quaternion, np.ascontiguousarray(axes).ravel())
    return PrincipalInertia(
        mass, np.array(inertial.origin.xyz), quaternion, moments, tuple(remarks)
    )


def _fits(mass: float, moment: float, centre: Array, box: Array | None) -> bool:
    """Return whether a body inside the box can have this mass, centre and moment."""
    if box is None:
        return False
    reach = np.sort(np.abs(box - centre).max(axis=0))
    return moment <= mass * (reach[1] ** 2 + reach[2] ** 2)


def _replaced_implausible(
    mass: float, moments: Array, axes: Array, box: Array | None, remarks: list[str]
) -> tuple[Array, Array]:
    """Replace an inertia that would need the mass metres from its centre; without box, warn."""
    radius = math.sqrt(moments[2] / mass)
    finding = (
        f"an inertia of {moments[2]:.3g} kg m2 on {mass:g} kg puts the mass {radius:.3g} m from "
        "its centre"
    )
    if radius > MILLIMETRES_M:
        finding += ", as a mesh in millimetres taken for metres does"
    if box is None:
        remarks.append(f"{finding}; it is used unchanged")
        return moments, axes
    moments = _box_moments(mass, box[1] - box[0])
    remarks.append(
        f"{finding}; its bounding box's inertia is used, up to {moments.max():.3g} kg m2"
    )
    return moments, np.eye(3)


def _box_moments(mass: float, size: Array) -> Array:
    x, y, z = size**2
    return mass / 12 * np.array([y + z, x + z, x + y])


def _physical(moments: Array, remarks: list[str]) -> Array:
    """Return moments above 0, none of which exceeds the sum of the other two."""
    if moments.max() < MIN_INERTIA:
        remarks.append(f"it has no inertia; {DEFAULT_INERTIA:g} kg m2 is used")
        return np.full(3, DEFAULT_INERTIA)
    problem = ""
    if moments.min() < -ROUNDING * moments.max():
        problem = f"a principal moment is below 0 ({moments.min():.3g} kg m2)"
    # A rod has very little inertia about its axis, and rolls accordingly; only 0 is replaced.
    there = np.where(moments > RELATIVE_ZERO * moments.max(), moments, ROUNDING * moments.max())
    moments = np.maximum(there, MIN_INERTIA)
    largest = moments.max()
    others = moments.sum() - largest
    # The margin keeps rounding from failing MuJoCo's own check.
    missing = (1 + 1e-9) * largest - others
    if missing > ROUNDING * largest:
        problem = problem or (
            f"{largest:.4g} kg m2 about one principal axis exceeds the sum about the other two"
        )
    if missing > 0:
        # In proportion, because rounding along a rod is many times the inertia about its axis.
        moments = np.where(moments == largest, moments, moments * (1 + missing / others))
    if problem:
        used = " ".join(f"{moment:.3g}" for moment in moments)
        remarks.append(f"its inertia is impossible: {problem}; {used} kg m2 is used")
    return moments
