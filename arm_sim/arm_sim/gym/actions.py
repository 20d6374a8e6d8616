"""Converts the actions of a policy to commands, one for each joint."""

from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass
from math import isfinite, pi

import numpy as np
from numpy.typing import NDArray

from arm_gazebo.robot.actuation import RobotJoint
from arm_sim.errors import CallError

Array = NDArray[np.float64]


@dataclass(frozen=True, slots=True)
class ActionMode:
    """How actions from -1 to 1 become commands.

    Attributes:
        interface: the command interface of the joints.
        meaning: for messages and documentation.
        scale: returns middle and half width of a joint's commands, given the joint and the time
            of one action.
        adds: whether an action is a change of the last command.
    """

    interface: str
    meaning: str
    scale: Callable[[RobotJoint, float], tuple[float, float]]
    adds: bool = False


def _range(joint: RobotJoint, decision_s: float) -> tuple[float, float]:
    lower, upper = _limits(joint)
    return (lower + upper) / 2.0, (upper - lower) / 2.0


def _effort(joint: RobotJoint, decision_s: float) -> tuple[float, float]:
    if not isfinite(joint.effort):
        raise CallError(
            f"joint '{joint.name}' has no effort limit, so an action of 1 has no meaning for it; "
            "give it one in the description, or choose other actions"
        )
    return 0.0, joint.effort


def _limits(joint: RobotJoint) -> tuple[float, float]:
    """Return the limits of a joint; [-pi, pi] for a joint that turns freely."""
    if isfinite(joint.lower) and isfinite(joint.upper):
        return joint.lower, joint.upper
    if joint.linear:
        raise CallError(f"the sliding joint '{joint.name}' needs position limits")
    return -pi, pi


ACTIONS: Mapping[str, ActionMode] = {
    "position": ActionMode("position", "a position between the joint's limits", _range),
    "step": ActionMode(
        "position",
        "a change of the commanded position, up to the joint's velocity limit",
        lambda joint, decision_s: (0.0, joint.velocity * decision_s),
        adds=True,
    ),
    "velocity": ActionMode(
        "velocity", "a velocity up to the joint's limit", lambda joint, _: (0.0, joint.velocity)
    ),
    "effort": ActionMode("effort", "an effort up to the joint's limit", _effort),
}
"""The modes of `ArmEnv` by name."""


class Commands:
    """Converts actions to commands, for one simulation or for many copies of it.

    Args:
        mode: name of one of `ACTIONS`.
        joints: the commanded joints.
        decision_s: time of one action.
    """

    def __init__(self, mode: str, joints: Sequence[RobotJoint], decision_s: float) -> None:
        self._mode = action_mode(mode)
        scales = [self._mode.scale(joint, decision_s) for joint in joints]
        self._middle, self._half = np.array(scales).reshape(-1, 2).T
        self.home = np.array([joint.initial for joint in joints])
        if self._mode.interface == "position":
            limits = [_limits(joint) for joint in joints]
            self._lower, self._upper = np.array(limits).reshape(-1, 2).T
        else:
            self._lower, self._upper = self._middle - self._half, self._middle + self._half

    def of(self, actions: NDArray[np.floating], last: Array) -> Array:
        """Return the commands of actions, clipped to -1 to 1; all have the shape (..., joints)."""
        # Not np.clip, which takes twice as long.
        share = np.minimum(np.maximum(np.asarray(actions, dtype=np.float64), -1.0), 1.0)
        base = last if self._mode.adds else self._middle
        return np.minimum(np.maximum(base + share * self._half, self._lower), self._upper)

    def action_to(self, wanted: Array, last: Array) -> NDArray[np.float32]:
        """Return the action that commands positions, or comes as near to them as one can.

        The wanted positions and the last commands have the shape (joints,).
        """
        base = last if self._mode.adds else self._middle
        return np.clip((wanted - base) / self._half, -1.0, 1.0).astype(np.float32)


def action_mode(name: str) -> ActionMode:
    """Return a mode by its name.

    Raises:
        CallError: there is none.
    """
    if name not in ACTIONS:
        raise CallError(f"no actions '{name}'; there are {', '.join(ACTIONS)}")
    return ACTIONS[name]
