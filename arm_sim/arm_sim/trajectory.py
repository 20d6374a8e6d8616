"""Trajectories as programs write them."""

from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from typing import Any, TypeAlias

import numpy as np
from numpy.typing import ArrayLike

from arm_control.controllers.joint_trajectory.trajectory import TrajectoryPoint, TrajectoryRequest
from arm_sim.errors import CallError


@dataclass(frozen=True, slots=True)
class JointTrajectory:
    """Waypoints of several joints.

    Attributes:
        times_s: time of each waypoint since the start, shape (m,).
        positions: shape (m, n), in rad or m.
        joints: names of the n joints; () for all joints of the controller in their order.
        velocities: shape (m, n), in rad/s or m/s; None for none.
        accelerations: shape (m, n), in rad/s² or m/s²; None for none.
    """

    times_s: ArrayLike
    positions: ArrayLike
    joints: Sequence[str] = ()
    velocities: ArrayLike | None = None
    accelerations: ArrayLike | None = None


AnyTrajectory: TypeAlias = JointTrajectory | TrajectoryRequest | Mapping[str, Any]
"""A `JointTrajectory`, a mapping with its attributes as keys, or the controller's own request."""


def trajectory_request(trajectory: AnyTrajectory, joints: Sequence[str]) -> TrajectoryRequest:
    """Return a trajectory in the controller's form, which the controller still has to check.

    Raises:
        CallError: it is not a trajectory.
    """
    if isinstance(trajectory, TrajectoryRequest):
        return trajectory
    if isinstance(trajectory, Mapping):
        try:
            trajectory = JointTrajectory(**trajectory)
        except TypeError as error:
            raise CallError(
                "a trajectory has the keys times_s, positions, joints, velocities and "
                f"accelerations, the last three optional; not {', '.join(map(str, trajectory))}"
            ) from error
    if not isinstance(trajectory, JointTrajectory):
        raise CallError(f"a trajectory is a JointTrajectory or a mapping, not {trajectory!r}")
    names = tuple(trajectory.joints) or tuple(joints)
    times_s = _array("times_s", trajectory.times_s, 1)
    rows = {
        name: _array(name, values, 2)
        for name, values in (
            ("positions", trajectory.positions),
            ("velocities", trajectory.velocities),
            ("accelerations", trajectory.accelerations),
        )
        if values is not None
    }
    for name, values in rows.items():
        if len(values) != len(times_s):
            raise CallError(f"the trajectory has {len(times_s)} times_s and {len(values)} {name}")
    points = [
        TrajectoryPoint(time_s, **{name: values[index].tolist() for name, values in rows.items()})
        for index, time_s in enumerate(times_s.tolist())
    ]
    return TrajectoryRequest(names, points)


def _array(name: str, values: ArrayLike, dimensions: int) -> np.ndarray:
    try:
        array = np.asarray(values, dtype=np.float64)
    except (TypeError, ValueError) as error:
        raise CallError(f"{name} of the trajectory must be numbers, not {values!r}") from error
    if array.ndim != dimensions:
        shape = "(m,)" if dimensions == 1 else "(m, n)"
        raise CallError(f"{name} of the trajectory needs the shape {shape}, not {array.shape}")
    return array
