"""Parameters of the joint trajectory controller, and the configuration that follows from them."""

import logging
from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from math import inf

import numpy as np
from numpy.typing import NDArray

from arm_control.controllers.joint_trajectory.goals import Tolerances
from arm_control.controllers.joint_trajectory.plans import QUANTITIES
from arm_control.controllers.joint_trajectory.trajectory import Interpolation
from arm_control.controllers.joint_trajectory.validation import (
    JointModel,
    LimitCheck,
    TrajectoryRules,
)
from arm_control.controllers.pid import AntiWindup, PidGains
from arm_control.errors import ControllerError, ParameterError
from arm_control.parameters import check_values, parameter, parameter_groups, specs_of
from arm_description.urdf.robot import Robot

LOWEST_MONITOR_RATE_HZ = 0.1


@dataclass(frozen=True, slots=True)
class _JointGains:
    """gains.<joint>: gains of the PID controller that computes velocities or efforts."""

    p: float = parameter(0.0, "Proportional gain")
    i: float = parameter(0.0, "Integral gain")
    d: float = parameter(0.0, "Derivative gain")
    i_clamp: float = parameter(inf, "Symmetric bound of the integral's contribution")
    i_clamp_max: float = parameter(inf, "Upper bound of the integral's contribution")
    i_clamp_min: float = parameter(-inf, "Lower bound of the integral's contribution")
    u_clamp_max: float = parameter(inf, "Upper bound of the output")
    u_clamp_min: float = parameter(-inf, "Lower bound of the output")
    ff_velocity_scale: float = parameter(0.0, "Fraction of the target velocity in the output")
    antiwindup_strategy: str = parameter(
        "legacy",
        "Anti-windup strategy",
        read_only=True,
        one_of=tuple(strategy.value for strategy in AntiWindup),
    )
    tracking_time_constant: float = parameter(0.0, "Of back_calculation, in s; 0: from the gains")
    error_deadband: float = parameter(0.0, "Errors up to this are not integrated")

    def as_pid_gains(self) -> PidGains:
        """Return the gains in the form that `Pid` takes."""
        return PidGains(
            p=self.p,
            i=self.i,
            d=self.d,
            i_max=min(self.i_clamp, self.i_clamp_max),
            i_min=max(-self.i_clamp, self.i_clamp_min),
            u_max=self.u_clamp_max,
            u_min=self.u_clamp_min,
            anti_windup=AntiWindup(self.antiwindup_strategy),
            tracking_time_constant=self.tracking_time_constant,
            error_deadband=self.error_deadband,
        )


@dataclass(frozen=True, slots=True)
class _JointConstraints:
    """constraints.<joint>: its tolerances and its deceleration."""

    trajectory: float = parameter(0.0, "Position tolerance along the path; 0 for none")
    goal: float = parameter(0.0, "Position tolerance at the goal; 0 for none")
    max_deceleration_on_cancel: float = parameter(
        0.0, "Deceleration for decelerate_on_cancel", read_only=True, at_least=0.0
    )


@dataclass(frozen=True, slots=True)
class Constraints:
    """Constraints of all joints."""

    stopped_velocity_tolerance: float = parameter(0.01, "Velocity tolerance at the goal")
    goal_time: float = parameter(0.0, "How late the goal may be, in s; 0: any time", at_least=0.0)
    decelerate_on_cancel: bool = parameter(
        False, "Brake when a goal is cancelled, instead of holding at once", read_only=True
    )


@dataclass(frozen=True, slots=True)
class SpeedScalingParameters:
    """The speed of trajectory time."""

    initial_scaling_factor: float = parameter(1.0, "Initial factor", read_only=True, at_least=0.0)
    state_interface: str = parameter("", "State interface of the factor", read_only=True)
    command_interface: str = parameter("", "Command interface of the factor", read_only=True)


@dataclass(frozen=True, slots=True)
class JointTrajectoryParameters:
    """All parameters.

    Attributes:
        gains: by joint.
        joint_constraints: by joint; their names begin with 'constraints.'.
    """

    joints: tuple[str, ...] = parameter((), "Joints to move", read_only=True)
    command_joints: tuple[str, ...] = parameter(
        (), "Joints to command; empty for `joints`", read_only=True
    )
    command_interfaces: tuple[str, ...] = parameter(
        (), "Command interfaces of each joint", read_only=True
    )
    state_interfaces: tuple[str, ...] = parameter(
        (), "State interfaces of each joint", read_only=True
    )
    allow_partial_joints_goal: bool = parameter(False, "Accept trajectories that omit joints")
    open_loop_control: bool = parameter(
        False, "Deprecated: like interpolate_from_desired_state, without PID", read_only=True
    )
    interpolate_from_desired_state: bool = parameter(
        False, "Start from the last command, not from the measured state", read_only=True
    )
    allow_integration_in_goal_trajectories: bool = parameter(
        False, "Accept points without positions, and integrate them"
    )
    set_last_command_interface_value_as_state_on_activation: bool = parameter(
        True, "At activation, hold the last command, not the measured position"
    )
    action_monitor_rate: float = parameter(
        20.0,
        "Feedback messages of the action per second of simulation time",
        read_only=True,
        at_least=LOWEST_MONITOR_RATE_HZ,
    )
    interpolation_method: str = parameter(
        "splines",
        "Interpolation between waypoints",
        read_only=True,
        one_of=tuple(method.value for method in Interpolation),
    )
    allow_nonzero_velocity_at_trajectory_end: bool = parameter(
        False, "Accept a last point with a velocity"
    )
    cmd_timeout: float = parameter(
        0.0, "Time after a trajectory's end until the joints hold, in s; 0 for never", at_least=0.0
    )
    reject_with_reason: bool = parameter(
        False, "Accept an invalid goal, then abort it with the reason"
    )
    check_position_limits: bool = parameter(
        False, "Refuse trajectories beyond the position limits of the robot description"
    )
    check_velocity_limits: bool = parameter(
        False, "Refuse trajectories beyond the velocity limits of the robot description"
    )
    smooth_replacement_time: float = parameter(
        0.0,
        "Time in s for a smooth change to a new trajectory; 0 for upstream's step",
        at_least=0.0,
    )
    speed_scaling: SpeedScalingParameters = SpeedScalingParameters()
    constraints: Constraints = Constraints()
    gains: Mapping[str, _JointGains] = parameter_groups(_JointGains, by="joints")
    joint_constraints: Mapping[str, _JointConstraints] = parameter_groups(
        _JointConstraints, by="joints", prefix="constraints"
    )

    def gains_of(self, joint: str) -> _JointGains:
        """Return the gains of a joint, or the defaults."""
        return self.gains.get(joint, _JointGains())

    def constraints_of(self, joint: str) -> _JointConstraints:
        """Return the constraints of a joint, or the defaults."""
        return self.joint_constraints.get(joint, _JointConstraints())

    def check(self) -> None:
        """Raise `ParameterError` if a value is out of its range."""
        check_values(self, specs_of(JointTrajectoryParameters))
        for joint, gains in self.gains.items():
            prefix = f"gains.{joint}."
            check_values(gains, specs_of(_JointGains, prefix), prefix)
        self.check_together()

    def check_together(self) -> None:
        """Raise `ParameterError` if values contradict each other."""
        for joint, gains in self.gains.items():
            if not gains.u_clamp_min <= gains.u_clamp_max:
                raise ParameterError(
                    f"parameter 'gains.{joint}.u_clamp_min' is {gains.u_clamp_min:g}, above "
                    f"u_clamp_max {gains.u_clamp_max:g}"
                )
            pid = gains.as_pid_gains()
            if not pid.i_min <= pid.i_max:
                raise ParameterError(
                    f"under 'gains.{joint}': i_clamp, i_clamp_min and i_clamp_max leave no "
                    f"range for the integral: {pid.i_min:g} to {pid.i_max:g}"
                )


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
class Configuration:
    """The controller's configuration for one set of parameters.

    Attributes:
        parameters: the parameters.
        interfaces: the interfaces.
        model: the joints' data from the robot description.
        rules: which trajectories are accepted.
        limits: which limits trajectories must keep; None for none.
        tolerances: the tolerances unless a goal sets its own.
        interpolation: method between waypoints.
        starts_from_command: whether a trajectory starts from the last command.
        deceleration: deceleration of each joint on cancel, shape (n,); None to hold at once.
        command_timeout_s: time after a trajectory's end until the joints hold; 0 for never.
        gains: gains of the PID controllers; empty if commands are not computed by PID.
        feedforward: fraction of the velocity set-point added to the PID output, shape (n,).
    """

    parameters: JointTrajectoryParameters
    interfaces: InterfaceLayout
    model: JointModel
    rules: TrajectoryRules
    limits: LimitCheck | None
    tolerances: Tolerances
    interpolation: Interpolation
    starts_from_command: bool
    deceleration: NDArray[np.float64] | None
    command_timeout_s: float
    gains: tuple[PidGains, ...]
    feedforward: NDArray[np.float64]

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
            rules=TrajectoryRules(
                joints=parameters.joints,
                allow_partial=parameters.allow_partial_joints_goal,
                allow_integration=parameters.allow_integration_in_goal_trajectories,
                allow_moving_end=parameters.allow_nonzero_velocity_at_trajectory_end,
                takes_effort=interfaces.commands("effort"),
            ),
            limits=_limits(parameters, model),
            tolerances=_tolerances(parameters),
            interpolation=Interpolation(parameters.interpolation_method),
            starts_from_command=parameters.interpolate_from_desired_state
            or parameters.open_loop_control
            or parameters.smooth_replacement_time > 0.0,
            deceleration=_deceleration(parameters, interfaces, model, logger),
            command_timeout_s=_command_timeout_s(parameters, logger),
            gains=tuple(g.as_pid_gains() for g in gains) if _needs_pid(parameters) else (),
            feedforward=np.array([g.ff_velocity_scale for g in gains]),
        )


def _limits(parameters: JointTrajectoryParameters, model: JointModel) -> LimitCheck | None:
    positions, velocities = parameters.check_position_limits, parameters.check_velocity_limits
    return LimitCheck(model, positions, velocities) if positions or velocities else None


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
) -> NDArray[np.float64] | None:
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


def _needs_pid(parameters: JointTrajectoryParameters) -> bool:
    commands = parameters.command_interfaces
    return commands == ("effort",) or (
        commands == ("velocity",) and not parameters.open_loop_control
    )
