"""Parameters of the joint trajectory controller."""

from collections.abc import Mapping, Sequence
from dataclasses import dataclass, field, fields
from math import inf
from typing import Any

from arm_control.errors import ParameterError
from arm_control.joint_trajectory.pid import AntiWindup, PidGains
from arm_control.joint_trajectory.trajectory import Interpolation
from arm_control.parameters import ParameterSpec, build_parameters, list_among, parameter, specs_of

LOWEST_MONITOR_RATE_HZ = 0.1


@dataclass(frozen=True, slots=True)
class JointGains:
    """gains.<joint>: of the PID controller that follows with velocities or efforts."""

    p: float = parameter(0.0, "Proportional gain")
    i: float = parameter(0.0, "Integral gain")
    d: float = parameter(0.0, "Derivative gain")
    i_clamp: float = parameter(inf, "Bound of the integral's part, in both directions")
    i_clamp_max: float = parameter(inf, "Upper bound of the integral's part")
    i_clamp_min: float = parameter(-inf, "Lower bound of the integral's part")
    u_clamp_max: float = parameter(inf, "Upper bound of the output")
    u_clamp_min: float = parameter(-inf, "Lower bound of the output")
    ff_velocity_scale: float = parameter(0.0, "Part of the wanted velocity added to the output")
    antiwindup_strategy: str = parameter(
        "legacy",
        "legacy, none, back_calculation or conditional_integration",
        read_only=True,
    )
    tracking_time_constant: float = parameter(0.0, "Of back_calculation, in s; 0 derives it")
    error_deadband: float = parameter(0.0, "An error up to this is not integrated")

    def as_pid_gains(self) -> PidGains:
        """Return the gains as the PID controller takes them."""
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
class JointConstraints:
    """constraints.<joint>: how closely it follows, how hard it brakes."""

    trajectory: float = parameter(0.0, "Position tolerance on the way; 0 for none")
    goal: float = parameter(0.0, "Position tolerance at the end; 0 for none")
    max_deceleration_on_cancel: float = parameter(
        0.0, "How hard it brakes with decelerate_on_cancel", read_only=True
    )


@dataclass(frozen=True, slots=True)
class Constraints:
    """What is common to all joints."""

    stopped_velocity_tolerance: float = parameter(0.01, "Velocity tolerance at the end")
    goal_time: float = parameter(0.0, "How late the end may be, in s; 0 for any time")
    decelerate_on_cancel: bool = parameter(
        False, "Brake when a goal is cancelled, instead of holding at once", read_only=True
    )


@dataclass(frozen=True, slots=True)
class SpeedScalingParameters:
    """How fast trajectory time runs."""

    initial_scaling_factor: float = parameter(1.0, "Factor to begin with", read_only=True)
    state_interface: str = parameter("", "State interface that tells the factor", read_only=True)
    command_interface: str = parameter("", "Command interface to hand it to", read_only=True)


@dataclass(frozen=True, slots=True)
class CommonParameters:
    """The parameters that do not depend on the names of the joints."""

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
    allow_partial_joints_goal: bool = parameter(False, "Take trajectories of some joints only")
    open_loop_control: bool = parameter(
        False, "Deprecated: as interpolate_from_desired_state, and no PID", read_only=True
    )
    interpolate_from_desired_state: bool = parameter(
        False, "Start from what was commanded last, not from what was measured", read_only=True
    )
    allow_integration_in_goal_trajectories: bool = parameter(
        False, "Take points without positions, and integrate"
    )
    set_last_command_interface_value_as_state_on_activation: bool = parameter(
        True, "Hold what was commanded last, not what was measured"
    )
    action_monitor_rate: float = parameter(
        20.0, "Feedback of the action per second of simulation time", read_only=True
    )
    interpolation_method: str = parameter("splines", "splines or none", read_only=True)
    allow_nonzero_velocity_at_trajectory_end: bool = parameter(
        False, "Take trajectories whose last point moves"
    )
    cmd_timeout: float = parameter(
        0.0, "Hold so long after the end of a trajectory, in s; 0 for never"
    )
    reject_with_reason: bool = parameter(
        False, "Accept a goal with a fault, and abort it with the reason"
    )
    check_position_limits: bool = parameter(
        False, "Refuse trajectories beyond the position limits of the robot description"
    )
    check_velocity_limits: bool = parameter(
        False, "Refuse trajectories beyond the velocity limits of the robot description"
    )
    smooth_replacement_time: float = parameter(
        0.0, "Join a new trajectory without a step, within so many s; 0 for upstream's step"
    )
    speed_scaling: SpeedScalingParameters = SpeedScalingParameters()
    constraints: Constraints = Constraints()


@dataclass(frozen=True, slots=True)
class JointTrajectoryParameters(CommonParameters):
    """All parameters.

    Attributes:
        gains: by joint.
        joint_constraints: by joint.
    """

    gains: Mapping[str, JointGains] = field(default_factory=dict)
    joint_constraints: Mapping[str, JointConstraints] = field(default_factory=dict)

    @classmethod
    def specs(cls, given: Mapping[str, Any]) -> tuple[ParameterSpec, ...]:
        """Return every parameter that there is for the joints among the given parameters."""
        specs = specs_of(CommonParameters)
        for joint in list_among(given, "joints"):
            specs += specs_of(JointGains, f"gains.{joint}.")
            specs += specs_of(JointConstraints, f"constraints.{joint}.")
        return specs

    @classmethod
    def build(cls, values: Mapping[str, Any]) -> "JointTrajectoryParameters":
        """Make an instance from values by full name; what is missing takes its default.

        Raises:
            ParameterError: a name is unknown, or a value cannot be used.
        """
        rest = dict(values)
        joints = list_among(rest, "joints")
        gains = {joint: _take(JointGains, f"gains.{joint}.", rest) for joint in joints}
        constraints = {
            joint: _take(JointConstraints, f"constraints.{joint}.", rest) for joint in joints
        }
        common = build_parameters(CommonParameters, rest)
        parameters = cls(
            **{item.name: getattr(common, item.name) for item in fields(common)},
            gains=gains,
            joint_constraints=constraints,
        )
        parameters.check()
        return parameters

    def gains_of(self, joint: str) -> JointGains:
        """Return the gains of a joint, the defaults where it has none of its own."""
        return self.gains.get(joint, JointGains())

    def constraints_of(self, joint: str) -> JointConstraints:
        """Return the constraints of a joint, the defaults where it has none of its own."""
        return self.joint_constraints.get(joint, JointConstraints())

    def check(self) -> None:
        """Raise `ParameterError` where a value is out of its range."""
        _at_least(LOWEST_MONITOR_RATE_HZ, "action_monitor_rate", self.action_monitor_rate)
        _at_least(0.0, "constraints.goal_time", self.constraints.goal_time)
        _at_least(0.0, "cmd_timeout", self.cmd_timeout)
        _at_least(0.0, "smooth_replacement_time", self.smooth_replacement_time)
        _at_least(
            0.0, "speed_scaling.initial_scaling_factor", self.speed_scaling.initial_scaling_factor
        )
        _one_of(
            [method.value for method in Interpolation],
            "interpolation_method",
            self.interpolation_method,
        )
        for joint, gains in self.gains.items():
            _one_of(
                [strategy.value for strategy in AntiWindup],
                f"gains.{joint}.antiwindup_strategy",
                gains.antiwindup_strategy,
            )
            if not gains.u_clamp_min <= gains.u_clamp_max:
                raise ParameterError(
                    f"parameter 'gains.{joint}.u_clamp_min' is {gains.u_clamp_min:g}, above "
                    f"u_clamp_max {gains.u_clamp_max:g}"
                )
            pid = gains.as_pid_gains()
            if not pid.i_min <= pid.i_max:
                raise ParameterError(
                    f"under 'gains.{joint}': i_clamp, i_clamp_min and i_clamp_max leave the "
                    f"integral's part nothing: from {pid.i_min:g} to {pid.i_max:g}"
                )


def _take(group: type[Any], prefix: str, values: dict[str, Any]) -> Any:
    """Take the values of a group out of `values`, and return the group."""
    names = [name for name in values if name.startswith(prefix)]
    own = {name.removeprefix(prefix): values.pop(name) for name in names}
    try:
        return build_parameters(group, own)
    except ParameterError as error:
        raise ParameterError(f"under '{prefix[:-1]}': {error}") from error


def _at_least(least: float, name: str, value: float) -> None:
    if not least <= value < inf:
        raise ParameterError(f"parameter '{name}' must be at least {least:g}, but is {value:g}")


def _one_of(choices: Sequence[str], name: str, value: str) -> None:
    if value not in choices:
        raise ParameterError(f"parameter '{name}' is '{value}'; it may be {' or '.join(choices)}")
