"""A robot with its planning groups and the limits of its joints."""

from collections.abc import Mapping
from dataclasses import dataclass, field

import numpy as np
from numpy.typing import NDArray

from arm_description.urdf.robot import Robot
from arm_node.names import listing
from arm_planning.errors import InvalidStateError, MoveItErrorCode, PlanningError

Array = NDArray[np.float64]
JointPositions = Mapping[str, float]
"""Position by joint name: rad for turning joints, m for sliding ones."""


@dataclass(frozen=True, slots=True)
class PlanningLimits:
    """The bounds of one joint, in rad or m, per s, s^2 and s^3; infinite where there is none."""

    lower: float
    upper: float
    velocity: float
    acceleration: float
    jerk: float = float("inf")


@dataclass(frozen=True, slots=True)
class JointGroup:
    """Joints that are planned together; all arrays follow the order of `joints`.

    Attributes:
        name: name of the group.
        joints: its active joints in the model's order: neither fixed nor mimic.
        continuous: whether each joint turns without end, (n,).
        limits: the limits of each joint.
        links: the links that are part of the group, in the model's order.
        base: the link that the first joint moves against, if the group is a chain.
        tip: its last link, which poses are for unless they name another; "" if it is no chain.
    """

    name: str
    joints: tuple[str, ...]
    continuous: tuple[bool, ...]
    limits: tuple[PlanningLimits, ...]
    links: tuple[str, ...]
    base: str = ""
    tip: str = ""

    @property
    def lower(self) -> Array:
        """Lower position limits, (n,); -inf for continuous joints."""
        return np.array([limit.lower for limit in self.limits])

    @property
    def upper(self) -> Array:
        """Upper position limits, (n,); inf for continuous joints."""
        return np.array([limit.upper for limit in self.limits])

    def positions(self, state: JointPositions) -> Array:
        """Return the group's positions in a state of the robot, (n,)."""
        return np.array([state[joint] for joint in self.joints])


@dataclass(frozen=True, slots=True)
class PlanningModel:
    """A robot, its groups and their named states.

    Attributes:
        robot: links and joints.
        frame: the planning frame: the root link, or the parent frame of the SRDF's virtual joint.
        joints: all active joints in tree order: scalar, neither fixed nor mimic.
        groups: the groups by name.
        states: named states as joint positions, by (group, state).
    """

    robot: Robot
    frame: str
    joints: tuple[str, ...]
    groups: Mapping[str, JointGroup]
    states: Mapping[tuple[str, str], JointPositions] = field(default_factory=dict)

    def group(self, name: str) -> JointGroup:
        """Return a group by name.

        Raises:
            PlanningError: INVALID_GROUP_NAME; the message names the groups that exist.
        """
        if name not in self.groups:
            raise PlanningError(
                MoveItErrorCode.INVALID_GROUP_NAME,
                f"no group '{name}'; the robot has {listing(self.groups)}",
            )
        return self.groups[name]

    def default_group(self) -> JointGroup:
        """Return the first group that is a chain, or the first one if there is no chain.

        Raises:
            PlanningError: INVALID_GROUP_NAME: the robot has no group.
        """
        if not self.groups:
            raise PlanningError(
                MoveItErrorCode.INVALID_GROUP_NAME, "the robot has no group to move"
            )
        groups = self.groups.values()
        return next((group for group in groups if group.tip), None) or next(iter(groups))

    def state(self, group: str, name: str) -> JointPositions:
        """Return a named state of a group.

        Raises:
            PlanningError: INVALID_GROUP_NAME or INVALID_ROBOT_STATE: the group or the state does
                not exist; the message names those that do.
        """
        known = {state: each for (owner, state), each in self.states.items() if owner == group}
        if name not in known:
            owner = self.group(group).name
            raise InvalidStateError(
                f"group '{owner}' has no state '{name}'; it has {listing(known)}"
            )
        return known[name]
