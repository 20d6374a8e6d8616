"""The controller's configuration: what follows from its parameters and the robot description."""

import logging
from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from arm_control.controllers.joint_trajectory.goals import Tolerances
from arm_control.controllers.joint_trajectory.parameters import JointTrajectoryParameters
from arm_control.controllers.joint_trajectory.profiles import QUANTITIES, Array
from arm_control.controllers.pid import PidGains
from arm_control.errors import ControllerError
from arm_description.urdf.robot import Robot

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
class InterfaceLayout:
    """The interfaces of one configuration.

    The values of the interfaces are ordered by joint; the controller computes with one row per
    quantity. The two index arrays convert between them.

    Attributes:
        joints: the joints whose states are read.
        command_names: full names of the command interfaces.
        state_names: full names of the state interfaces.
        command_rows: commanded quantities, in the order of a motion's rows.
        state_rows: measured quantities, likewise; always the first rows of a motion.
        command_index: index of each command in the flat array of commanded rows.
        state_index: index of each measured value among the states, shape (rows, n).
        commanded: index of each command joint among `joints`.
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
    def of(cls, parameters: JointTrajectoryParameters) -> "InterfaceLayout":
        """Return the interfaces that the parameters require.

        Raises:
            ControllerError: they name joints or interfaces that do not match.
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
    def passive(self) -> NDArray[np.intp]:
        """Index of each joint that is read but not commanded."""
        return np.setdiff1d(np.arange(len(self.joints)), self.commanded)

    @property
    def measures_velocity(self) -> bool:
        """Whether the joints' velocities are measured."""
        return QUANTITIES.index("velocity") in self.state_rows

    def commands(self, quantity: str) -> bool:
        """Return whether a quantity is commanded."""
        return QUANTITIES.index(quantity) in self.command_rows

    @property
    def checked_rows(self) -> int:
        """How many rows have an error.

        Position always has one; velocity has one if it is measured and velocity or effort is
        commanded; acceleration has one if it is measured and commanded.
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
    unknown = [name for name in command_joints if name not in joints]
    if unknown and len(command_joints) < len(joints):
        raise ControllerError(
            f"'command_joints' parameter names fewer joints than 'joints', so each must be one "
            f"of these; unknown: {', '.join(unknown)}"
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
    """Return the index of each command joint: by order if all joints have one, else by name."""
    if not command_joints or len(command_joints) == len(joints):
        return np.arange(len(joints), dtype=np.intp)
    return np.array([joints.index(name) for name in command_joints], dtype=np.intp)


@dataclass(frozen=True, slots=True)
class JointModel:
    """A controller's joints in the robot description, in the controller's order.

    Attributes:
        joints: their names.
        continuous: which joints are continuous, shape (n,).
        turns: whether any of them is.
        units: units of their positions, rad or m.
        lower: lower position limits, shape (n,); -inf for no limit.
        upper: upper position limits, shape (n,); inf for no limit.
        velocity: velocity limits, shape (n,); inf for no limit.
    """

    joints: tuple[str, ...]
    continuous: NDArray[np.bool_]
    turns: bool
    units: tuple[str, ...]
    lower: Array
    upper: Array
    velocity: Array

    @classmethod
    def of(cls, robot: Robot | None, names: Sequence[str]) -> "JointModel":
        """Look up joints; one that the robot does not have gets no limits."""
        known = {joint.name: joint for joint in robot.joints} if robot else {}
        joints = [known.get(name) for name in names]
        limits = [joint.limit if joint else None for joint in joints]
        continuous = [joint is not None and joint.type.wraps for joint in joints]
        return cls(
            tuple(names),
            np.array(continuous),
            any(continuous),
            tuple(joint.type.unit if joint else "rad" for joint in joints),
            np.array([limit.lower if limit else -np.inf for limit in limits]),
            np.array([limit.upper if limit else np.inf for limit in limits]),
            np.array([limit.velocity if limit and limit.velocity else np.inf for limit in limits]),
        )


@dataclass(frozen=True, slots=True)
class Configuration:
    """What follows from one set of parameters.

    Attributes:
        parameters: the parameters.
        interfaces: the interfaces.
        model: the joints' data from the robot description.
        tolerances: the tolerances unless a goal sets its own.
        deceleration: deceleration of each joint on cancel, shape (n,); None to hold at once.
        command_timeout_s: time after a trajectory's end until the joints hold; 0 for never.
        gains: gains of the PID controllers; empty if commands are not computed by PID.
        feedforward: fraction of the velocity set-point added to the PID output, shape (n,).
    """

    parameters: JointTrajectoryParameters
    interfaces: InterfaceLayout
    model: JointModel
    tolerances: Tolerances
    deceleration: Array | None
    command_timeout_s: float
    gains: tuple[PidGains, ...]
    feedforward: Array

    @classmethod
    def of(
        cls, parameters: JointTrajectoryParameters, robot: Robot | None, logger: logging.Logger
    ) -> "Configuration":
        """Derive the configuration; log settings that cannot be met.

        Raises:
            ParameterError: a value is out of its range.
            ControllerError: values do not match.
        """
        parameters.check()
        interfaces = InterfaceLayout.of(parameters)
        model = JointModel.of(robot, parameters.joints)
        gains = [parameters.gains_of(joint) for joint in parameters.joints]
        return cls(
            parameters=parameters,
            interfaces=interfaces,
            model=model,
            tolerances=_tolerances(parameters),
            deceleration=_deceleration(parameters, interfaces, model, logger),
            command_timeout_s=_command_timeout_s(parameters, logger),
            gains=tuple(g.as_pid_gains() for g in gains) if parameters.needs_pid else (),
            feedforward=np.array([g.ff_velocity_scale for g in gains]),
        )


def _tolerances(parameters: JointTrajectoryParameters) -> Tolerances:
    constraints = [parameters.constraints_of(joint) for joint in parameters.joints]
    return Tolerances.of(
        path=np.array([constraint.trajectory for constraint in constraints]),
        goal=np.array([constraint.goal for constraint in constraints]),
        stopped_velocity=parameters.constraints.stopped_velocity_tolerance,
        goal_time_s=parameters.constraints.goal_time,
    )


def _deceleration(
    parameters: JointTrajectoryParameters,
    interfaces: InterfaceLayout,
    model: JointModel,
    logger: logging.Logger,
) -> Array | None:
    if not parameters.constraints.decelerate_on_cancel:
        return None
    deceleration = np.array(
        [parameters.constraints_of(j).max_deceleration_on_cancel for j in parameters.joints]
    )
    missing: list[str] = []
    if not interfaces.measures_velocity:
        missing.append("the 'velocity' state interface")
    for joint, brake, limit in zip(model.joints, deceleration, model.velocity, strict=True):
        if not brake > 0.0:
            missing.append(f"a positive constraints.{joint}.max_deceleration_on_cancel")
        if not np.isfinite(limit):
            missing.append(f"a velocity limit of joint {joint} in the robot description")
    if missing:
        logger.error(
            "decelerate_on_cancel needs %s: the joints will be held at once on cancel",
            ", ".join(missing),
        )
        return None
    return deceleration


def _command_timeout_s(parameters: JointTrajectoryParameters, logger: logging.Logger) -> float:
    timeout_s, goal_time_s = parameters.cmd_timeout, parameters.constraints.goal_time
    if 0.0 < timeout_s <= goal_time_s:
        logger.warning(
            "cmd_timeout (%g s) is off: it must be greater than constraints.goal_time (%g s)",
            timeout_s,
            goal_time_s,
        )
        return 0.0
    return timeout_s
