"""Which interfaces the controller uses, and how their values are ordered."""

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from arm_control.errors import ControllerError
from arm_control.joint_trajectory.motion import QUANTITIES
from arm_control.joint_trajectory.parameters import JointTrajectoryParameters

_COMMANDS = (
    {"position"},
    {"position", "velocity"},
    {"position", "velocity", "acceleration"},
    {"position", "effort"},
    {"velocity"},
    {"effort"},
)
_STATES = ({"position"}, {"position", "velocity"}, {"position", "velocity", "acceleration"})


@dataclass(frozen=True, slots=True)
class Wiring:
    """The interfaces of one configuration.

    Values of a robot's interfaces come joint by joint; the controller computes with one row for
    each quantity. The two index arrays lead from the one to the other.

    Attributes:
        joints: the joints whose states are read.
        command_names: full names of the command interfaces.
        state_names: full names of the state interfaces.
        command_rows: commanded quantities in the order of the rows of a motion.
        state_rows: measured quantities, likewise; always the first rows of a motion.
        command_index: where each command stands in the flat array of commanded rows.
        state_index: where each value of the measured rows stands among the states; its shape is
            (rows, n).
        commanded: index of the command joints among `joints`.
    """

    joints: tuple[str, ...]
    command_names: tuple[str, ...]
    state_names: tuple[str, ...]
    command_rows: tuple[int, ...]
    state_rows: tuple[int, ...]
    command_index: NDArray[np.intp]
    state_index: NDArray[np.intp]
    commanded: NDArray[np.intp]

    @classmethod
    def of(cls, parameters: JointTrajectoryParameters) -> "Wiring":
        """Work out the interfaces of parameters.

        Raises:
            ControllerError: they name joints or interfaces that do not go together.
        """
        joints = parameters.joints
        _check_joints(joints, parameters.command_joints)
        _check_kinds(parameters)
        commanded = _commanded(joints, parameters.command_joints)
        commands, states = parameters.command_interfaces, parameters.state_interfaces
        command_rows, state_rows = _rows(commands), _rows(states)
        command_joints = parameters.command_joints or joints
        row_of = {row: i for i, row in enumerate(command_rows)}
        return cls(
            joints=joints,
            command_names=tuple(f"{j}/{kind}" for j in command_joints for kind in commands),
            state_names=tuple(f"{j}/{kind}" for j in joints for kind in states),
            command_rows=command_rows,
            state_rows=state_rows,
            command_index=np.array(
                [
                    row_of[QUANTITIES.index(kind)] * len(joints) + joint
                    for joint in commanded
                    for kind in commands
                ],
                dtype=np.intp,
            ),
            state_index=np.array(
                [
                    [j * len(states) + states.index(QUANTITIES[row]) for j in range(len(joints))]
                    for row in state_rows
                ],
                dtype=np.intp,
            ),
            commanded=commanded,
        )

    @property
    def measures_velocity(self) -> bool:
        """Whether the joints' velocities are measured."""
        return QUANTITIES.index("velocity") in self.state_rows

    def commands(self, quantity: str) -> bool:
        """Return whether a quantity is commanded."""
        return QUANTITIES.index(quantity) in self.command_rows

    @property
    def checked_rows(self) -> int:
        """How many rows have an error: those measured whose commands lead anywhere.

        There is always one of position; one of velocity where velocities are measured and
        velocity or effort is commanded; one of acceleration where it is measured and commanded.
        """
        if not (self.measures_velocity and (self.commands("velocity") or self.commands("effort"))):
            return 1
        has_acceleration = len(self.state_rows) == 3 and self.commands("acceleration")
        return 3 if has_acceleration else 2


def _rows(kinds: Sequence[str]) -> tuple[int, ...]:
    return tuple(sorted(QUANTITIES.index(kind) for kind in kinds))


def _check_joints(joints: Sequence[str], command_joints: Sequence[str]) -> None:
    if not joints:
        raise ControllerError("'joints' parameter is empty")
    for name, names in (("joints", joints), ("command_joints", command_joints)):
        if len(set(names)) < len(names):
            raise ControllerError(f"parameter '{name}' names a joint twice: {', '.join(names)}")
    if len(command_joints) > len(joints):
        raise ControllerError(
            f"'command_joints' parameter has {len(command_joints)} joints, more than the "
            f"{len(joints)} of 'joints'"
        )
    strangers = [name for name in command_joints if name not in joints]
    if strangers and len(command_joints) < len(joints):
        raise ControllerError(
            f"'command_joints' parameter names fewer joints than 'joints', so each must be one "
            f"of these; not so: {', '.join(strangers)}"
        )


def _check_kinds(parameters: JointTrajectoryParameters) -> None:
    commands, states = parameters.command_interfaces, parameters.state_interfaces
    for name, kinds, legal in (
        ("command_interfaces", commands, _COMMANDS),
        ("state_interfaces", states, _STATES),
    ):
        if not kinds:
            raise ControllerError(f"'{name}' parameter is empty")
        if len(set(kinds)) < len(kinds) or set(kinds) not in legal:
            raise ControllerError(
                f"parameter '{name}' is [{', '.join(kinds)}]; it may be "
                + " or ".join(f"[{_listed(kinds)}]" for kinds in legal)
            )
    for kind, is_used in (
        ("velocity", commands == ("velocity",)),
        ("effort", "effort" in commands),
    ):
        if is_used and "velocity" not in states:
            raise ControllerError(
                f"'{kind}' command interface can only be used like this if 'velocity' and "
                "'position' state interfaces are present"
            )


def _listed(kinds: set[str]) -> str:
    return ", ".join(kind for kind in QUANTITIES if kind in kinds)


def _commanded(joints: Sequence[str], command_joints: Sequence[str]) -> NDArray[np.intp]:
    """Return the index of each command joint: by place where all joints have one, else by name."""
    if not command_joints or len(command_joints) == len(joints):
        return np.arange(len(joints), dtype=np.intp)
    return np.array([joints.index(name) for name in command_joints], dtype=np.intp)
