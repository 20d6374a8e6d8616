"""The solid ellipsoid that has a link's mass and inertia."""

import math

import numpy as np

from arm_description.robot import Inertial
from arm_viewer.scene.frame_poses import Quaternion, Vector


def inertia_ellipsoid(inertial: Inertial) -> tuple[Vector, Quaternion] | None:
    """Return the semi-axes in m, and how they lie in the axes of the inertial's origin.

    A solid ellipsoid with the semi-axes a, b, c has Ixx = m (b^2 + c^2) / 5 and so on, hence
    a^2 = 5 (Iyy + Izz - Ixx) / 2 m. The rotation is a unit quaternion (x, y, z, w).

    Returns:
        None where no body has such an inertia: no mass, or one moment above the others' sum.
    """
    ixx, ixy, ixz, iyy, iyz, izz = inertial.inertia
    values = np.array([[ixx, ixy, ixz], [ixy, iyy, iyz], [ixz, iyz, izz]])
    if not (inertial.mass > 0.0 and np.isfinite(values).all()):
        return None
    moments, axes = np.linalg.eigh(values)
    squares = 2.5 * (moments.sum() - 2.0 * moments) / inertial.mass
    # A rod or a plate is the limit of what is possible: rounding may bring it just beyond.
    if squares.min() < -1e-9 * max(squares.max(), 0.0) or squares.max() <= 0.0:
        return None
    if np.linalg.det(axes) < 0.0:
        axes[:, 2] = -axes[:, 2]
    a, b, c = np.sqrt(np.maximum(squares, 0.0)).tolist()
    return (a, b, c), _quaternion(axes)


def _quaternion(rotation: np.ndarray) -> Quaternion:
    """Return the quaternion of a rotation matrix, by way of its largest component (Shepperd)."""
    trace = float(np.trace(rotation))
    diagonal = [float(rotation[i, i]) for i in range(3)]
    i = int(np.argmax([*diagonal, trace]))
    q = [0.0, 0.0, 0.0, 0.0]
    if i == 3:
        q[3] = 1.0 + trace
        for k in range(3):
            q[k] = float(rotation[(k + 2) % 3, (k + 1) % 3] - rotation[(k + 1) % 3, (k + 2) % 3])
    else:
        j, k = (i + 1) % 3, (i + 2) % 3
        q[i] = 1.0 - trace + 2.0 * diagonal[i]
        q[j] = float(rotation[j, i] + rotation[i, j])
        q[k] = float(rotation[k, i] + rotation[i, k])
        q[3] = float(rotation[k, j] - rotation[j, k])
    x, y, z, w = (component / math.hypot(*q) for component in q)
    return x, y, z, w
