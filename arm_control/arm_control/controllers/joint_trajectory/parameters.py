"""Parameters of the joint trajectory controller."""

from collections.abc import Mapping
from dataclasses import dataclass
from math import inf

from arm_control.controllers.joint_trajectory.trajectory import Interpolation
from arm_control.controllers.pid import AntiWindup, PidGains
from arm_control.errors import ParameterError
from arm_control.parameters import check_values, parameter, parameter_groups, specs_of

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

    @property
    def starts_from_command(self) -> bool:
        """Whether a trajectory starts from the last command, not from the measured state."""
        return (
            self.interpolate_from_desired_state
            or self.open_loop_control
            or self.smooth_replacement_time > 0.0
        )

    @property
    def needs_pid(self) -> bool:
        """Whether PID controllers compute the commands."""
        return self.command_interfaces == ("effort",) or (
            self.command_interfaces == ("velocity",) and not self.open_loop_control
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
