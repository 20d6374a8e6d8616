"""Parameters of the gripper controllers."""

from dataclasses import dataclass

from arm_control.controllers.pid import PidGains
from arm_control.errors import ParameterError
from arm_control.parameters import check_values, parameter, parameter_groups, specs_of

LOWEST_MONITOR_RATE_HZ = 0.1
JOINT = "The joint that opens and closes the gripper"
MONITOR_RATE = (
    "ros2_control parameter without effect: results are sent in the cycle of a goal's end"
)

LIMIT_OF_EFFORT = "Full name of the command interface for the effort limit; empty for none"


@dataclass(frozen=True, slots=True)
class GripperParameters:
    """Parameters of all gripper controllers."""

    joint: str = parameter("", JOINT, at_configuration=True)
    action_monitor_rate: float = parameter(20.0, MONITOR_RATE, at_least=LOWEST_MONITOR_RATE_HZ)
    goal_tolerance: float = parameter(
        0.01, "A joint closer than this has reached its goal, in rad or m", at_least=0.0
    )
    max_effort: float = parameter(
        0.0, "Effort limit if the goal has none, in N m or N", at_least=0.0
    )
    allow_stalling: bool = parameter(
        False, "A goal whose joint stalls succeeds instead of being aborted"
    )
    stall_velocity_threshold: float = parameter(
        0.001, "A joint no faster than this is at rest, in rad/s or m/s", at_least=0.0
    )
    stall_timeout: float = parameter(
        1.0, "A joint at rest for longer than this has stalled, in s", at_least=0.0
    )

    def check(self) -> None:
        """Raise `ParameterError` if a value is out of its range."""
        check_values(self, specs_of(type(self)))


@dataclass(frozen=True, slots=True)
class PositionGripperParameters(GripperParameters):
    """Parameters of the controller for hardware with position commands."""

    max_effort_interface: str = parameter("", LIMIT_OF_EFFORT, read_only=True)


@dataclass(frozen=True, slots=True)
class ParallelGripperParameters(GripperParameters):
    """Parameters of the controller for hardware that limits effort and velocity itself."""

    joint: str = parameter("", JOINT, read_only=True)
    action_monitor_rate: float = parameter(
        20.0, MONITOR_RATE, read_only=True, at_least=LOWEST_MONITOR_RATE_HZ
    )
    max_effort: float = parameter(
        10.0, "Effort limit if the goal has none, in N m or N", at_least=0.0
    )
    state_interfaces: tuple[str, ...] = parameter(
        ("position", "velocity"), "States of the joint to read", at_configuration=True
    )
    max_effort_interface: str = parameter("", LIMIT_OF_EFFORT, at_configuration=True)
    max_velocity: float = parameter(
        0.1, "Velocity limit if the goal has none, in rad/s or m/s", at_least=0.0
    )
    max_velocity_interface: str = parameter(
        "",
        "Full name of the command interface for the velocity limit; empty for none",
        at_configuration=True,
    )


@dataclass(frozen=True, slots=True)
class _GripperGains:
    """gains.<joint>: gains of the PID controller from position to effort."""

    p: float = parameter(0.0, "Proportional gain")
    i: float = parameter(0.0, "Integral gain")
    d: float = parameter(0.0, "Derivative gain")
    i_clamp: float = parameter(0.0, "Symmetric bound of the integral's contribution")


@dataclass(frozen=True, slots=True)
class EffortGripperParameters(GripperParameters):
    """Parameters of the controller that commands efforts.

    Attributes:
        gains: PID gains of its joint.
    """

    # Read-only: the gains of a loaded controller are named after this joint.
    joint: str = parameter("", JOINT, read_only=True)
    gains: _GripperGains = parameter_groups(_GripperGains, by="joint", single=True)

    @property
    def pid_gains(self) -> PidGains:
        """The gains in the PID controller's form."""
        gains = self.gains
        return PidGains(gains.p, gains.i, gains.d, i_max=gains.i_clamp, i_min=-gains.i_clamp)

    def check(self) -> None:
        """Raise `ParameterError` if a value is out of its range."""
        GripperParameters.check(self)
        # Infinity is allowed: it means no bound.
        if not self.gains.i_clamp >= 0.0:
            raise ParameterError(
                f"parameter 'gains.{self.joint}.i_clamp' must be at least 0, "
                f"but is {self.gains.i_clamp:g}"
            )
