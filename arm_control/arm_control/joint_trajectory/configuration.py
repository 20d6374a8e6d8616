"""What follows from the parameters and the robot description."""

import logging
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from arm_control.joint_trajectory.limits import JointModel, LimitCheck
from arm_control.joint_trajectory.parameters import JointTrajectoryParameters
from arm_control.joint_trajectory.pid import PidGains
from arm_control.joint_trajectory.tolerances import Tolerances
from arm_control.joint_trajectory.trajectory import Interpolation
from arm_control.joint_trajectory.validation import TrajectoryRules
from arm_control.joint_trajectory.wiring import Wiring
from arm_description.robot import Robot


@dataclass(frozen=True, slots=True)
class Configuration:
    """How the controller works while its parameters stay as they are.

    Attributes:
        parameters: the parameters themselves.
        wiring: the interfaces.
        model: what the robot description says of the joints.
        rules: which trajectories are taken.
        limits: which limits they have to keep; None for none.
        tolerances: what is checked where a goal does not say otherwise.
        interpolation: what happens between way points.
        starts_from_command: whether a trajectory starts from what was commanded last.
        deceleration: how hard each joint brakes on cancel, shape (n,); None to hold at once.
        command_timeout_s: when to hold after the end of a trajectory; 0 for never.
        gains: of the PID controllers; empty where commands are not computed by any.
        feedforward: part of the wanted velocity that their output begins with, shape (n,).
    """

    parameters: JointTrajectoryParameters
    wiring: Wiring
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
        """Work everything out; what cannot be had goes to the log.

        Raises:
            ParameterError: a value is out of its range.
            ControllerError: values do not go together.
        """
        parameters.check()
        wiring = Wiring.of(parameters)
        model = JointModel.of(robot, parameters.joints)
        gains = [parameters.gains_of(joint) for joint in parameters.joints]
        return cls(
            parameters=parameters,
            wiring=wiring,
            model=model,
            rules=TrajectoryRules(
                joints=parameters.joints,
                allow_partial=parameters.allow_partial_joints_goal,
                allow_integration=parameters.allow_integration_in_goal_trajectories,
                allow_moving_end=parameters.allow_nonzero_velocity_at_trajectory_end,
                takes_effort=wiring.commands("effort"),
            ),
            limits=_limits(parameters, model),
            tolerances=_tolerances(parameters),
            interpolation=Interpolation(parameters.interpolation_method),
            starts_from_command=parameters.interpolate_from_desired_state
            or parameters.open_loop_control
            or parameters.smooth_replacement_time > 0.0,
            deceleration=_deceleration(parameters, wiring, model, logger),
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
    wiring: Wiring,
    model: JointModel,
    logger: logging.Logger,
) -> NDArray[np.float64] | None:
    if not parameters.constraints.decelerate_on_cancel:
        return None
    deceleration = np.array(
        [parameters.constraints_of(j).max_deceleration_on_cancel for j in parameters.joints]
    )
    lacks: list[str] = []
    if not wiring.measures_velocity:
        lacks.append("the 'velocity' state interface")
    for joint, brake, limit in zip(model.joints, deceleration, model.velocity, strict=True):
        if not brake > 0.0:
            lacks.append(f"a positive constraints.{joint}.max_deceleration_on_cancel")
        if not np.isfinite(limit):
            lacks.append(f"a velocity limit of joint {joint} in the robot description")
    if lacks:
        logger.error(
            "decelerate_on_cancel needs %s: the joints will be held at once on cancel",
            ", ".join(lacks),
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
