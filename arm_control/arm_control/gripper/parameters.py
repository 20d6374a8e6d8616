"""Parameters of the gripper controllers."""

from collections.abc import Mapping
from dataclasses import dataclass, field, fields
from math import inf
from typing import Any

from arm_control.errors import ParameterError
from arm_control.joint_trajectory.pid import PidGains
from arm_control.parameters import ParameterSpec, build_parameters, parameter, specs_of

LOWEST_MONITOR_RATE_HZ = 0.1
JOINT = "The joint that opens and closes the gripper"
MONITOR_RATE = "Known from ros2_control, without effect: a result is out in the cycle of the end"

LIMIT_OF_EFFORT = (
    "Full name of the command interface that takes the limit of effort; empty for none"
)


@dataclass(frozen=True, slots=True)
class GripperParameters:
    """What all gripper controllers have."""

    joint: str = parameter("", JOINT)
    action_monitor_rate: float = parameter(20.0, MONITOR_RATE)
    goal_tolerance: float = parameter(0.01, "A joint nearer to its goal is there, in rad or m")
    max_effort: float = parameter(0.0, "Most effort to spend where no goal says how much")
    allow_stalling: bool = parameter(
        False, "A goal on whose way the joint stops succeeds, instead of being aborted"
    )
    stall_velocity_threshold: float = parameter(
        0.001, "A joint no faster than this stands still, in rad/s or m/s"
    )
    stall_timeout: float = parameter(1.0, "A joint that stands still for longer is stuck, in s")

    def check(self) -> None:
        """Raise `ParameterError` where a value is out of its range."""
        _at_least(LOWEST_MONITOR_RATE_HZ, "action_monitor_rate", self.action_monitor_rate)
        for item in fields(self):
            value = getattr(self, item.name)
            if isinstance(value, float):
                _at_least(0.0, item.name, value)


@dataclass(frozen=True, slots=True)
class PositionGripperParameters(GripperParameters):
    """Parameters of the controller for hardware that goes where it is told."""

    max_effort_interface: str = parameter("", LIMIT_OF_EFFORT, read_only=True)


@dataclass(frozen=True, slots=True)
class ParallelGripperParameters(GripperParameters):
    """Parameters of the controller for hardware that limits effort and velocity itself."""

    joint: str = parameter("", JOINT, read_only=True)
    action_monitor_rate: float = parameter(20.0, MONITOR_RATE, read_only=True)
    max_effort: float = parameter(10.0, "Most effort to spend where no goal says how much")
    state_interfaces: tuple[str, ...] = parameter(
        ("position", "velocity"), "States of the joint to read"
    )
    max_effort_interface: str = parameter("", LIMIT_OF_EFFORT)
    max_velocity: float = parameter(0.1, "Fastest motion where no goal says more, in rad/s or m/s")
    max_velocity_interface: str = parameter(
        "", "Full name of the command interface that takes the limit of velocity; empty for none"
    )


@dataclass(frozen=True, slots=True)
class GripperGains:
    """gains.<joint>: of the PID controller that turns a position into an effort."""

    p: float = parameter(0.0, "Proportional gain")
    i: float = parameter(0.0, "Integral gain")
    d: float = parameter(0.0, "Derivative gain")
    i_clamp: float = parameter(0.0, "Bound of the integral's part, in both directions")


@dataclass(frozen=True, slots=True)
class CommonEffortGripperParameters(GripperParameters):
    """The parameters that do not depend on the name of the joint."""

    # The gains of another joint are no parameters of a controller that is loaded already.
    joint: str = parameter("", JOINT, read_only=True)


@dataclass(frozen=True, slots=True)
class EffortGripperParameters(CommonEffortGripperParameters):
    """Parameters of the controller that commands efforts.

    Attributes:
        gains: of its joint.
    """

    gains: GripperGains = field(default_factory=GripperGains)

    @property
    def pid_gains(self) -> PidGains:
        """The gains as the PID controller takes them."""
        gains = self.gains
        return PidGains(gains.p, gains.i, gains.d, i_max=gains.i_clamp, i_min=-gains.i_clamp)

    @classmethod
    def specs(cls, given: Mapping[str, Any]) -> tuple[ParameterSpec, ...]:
        """Return every parameter that there is for the joint among the given parameters."""
        joint = given.get("joint")
        gains = specs_of(GripperGains, _prefix(joint)) if joint else ()
        return (*specs_of(CommonEffortGripperParameters), *gains)

    @classmethod
    def build(cls, values: Mapping[str, Any]) -> "EffortGripperParameters":
        """Make an instance from values by full name; what is missing takes its default.

        Raises:
            ParameterError: a name is unknown, or a value cannot be used.
        """
        prefix = _prefix(values.get("joint"))
        own = {name: value for name, value in values.items() if name.startswith(prefix)}
        common = build_parameters(
            CommonEffortGripperParameters, {n: v for n, v in values.items() if n not in own}
        )
        gains = build_parameters(
            GripperGains, {name.removeprefix(prefix): value for name, value in own.items()}
        )
        return cls(
            **{item.name: getattr(common, item.name) for item in fields(common)}, gains=gains
        )

    def check(self) -> None:
        """Raise `ParameterError` where a value is out of its range."""
        GripperParameters.check(self)
        # Infinity is no bound, which is in order.
        if not self.gains.i_clamp >= 0.0:
            raise ParameterError(
                f"parameter '{_prefix(self.joint)}i_clamp' must be at least 0, "
                f"but is {self.gains.i_clamp:g}"
            )


def _prefix(joint: object) -> str:
    return f"gains.{joint}."


def _at_least(least: float, name: str, value: float) -> None:
    if not least <= value < inf:
        raise ParameterError(f"parameter '{name}' must be at least {least:g}, but is {value:g}")
