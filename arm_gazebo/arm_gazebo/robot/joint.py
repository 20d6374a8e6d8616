"""A joint of the robot as the running simulation knows it."""

import math
from dataclasses import dataclass


@dataclass(frozen=True, slots=True)
class RobotJoint:
    """A joint with one degree of freedom; positions in rad or m.

    Attributes:
        name: as in the URDF.
        qpos_address: index in `data.qpos`.
        dof_address: index in `data.qvel`.
        actuator: index in `data.ctrl` and of its activation, None where nothing drives it.
        lower: lowest position, -inf if it has no bound.
        upper: highest position, inf if it has no bound.
        velocity: highest speed of a set-point on its way to a position, above 0.
        velocity_limit: highest speed at all, inf if it has no bound.
        effort: highest force or torque, inf if it has no bound.
        initial: position at the start.
        linear: whether it slides; otherwise it turns.
    """

    name: str
    qpos_address: int
    dof_address: int
    actuator: int | None
    lower: float = -math.inf
    upper: float = math.inf
    velocity: float = math.inf
    velocity_limit: float = math.inf
    effort: float = math.inf
    initial: float = 0.0
    linear: bool = False
