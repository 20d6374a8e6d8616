"""Parameters of diff_drive_controller/DiffDriveController, and its limits on speeds."""

from dataclasses import dataclass, field, fields, replace
from math import inf, isnan, nan

from arm_control.controllers.diff_drive.odometry import WheelGeometry
from arm_control.controllers.drive import NO_COVARIANCE, check_covariances
from arm_control.errors import ControllerError, ParameterError
from arm_control.parameters import check_values, parameter, specs_of


@dataclass(frozen=True, slots=True)
class SpeedLimits:
    """Limits of a velocity along or about an axis and of its derivatives; NaN for no limit."""

    max_velocity: float = parameter(nan, "Upper bound")
    min_velocity: float = parameter(nan, "Lower bound; default -max_velocity")
    max_acceleration: float = parameter(nan, "Upper bound of the acceleration forwards")
    max_deceleration: float = parameter(
        nan, "Lower bound of the deceleration forwards; default max_acceleration_reverse"
    )
    max_acceleration_reverse: float = parameter(
        nan, "Lower bound of the acceleration backwards; default -max_acceleration"
    )
    max_deceleration_reverse: float = parameter(
        nan, "Upper bound of the deceleration backwards; default max_acceleration"
    )
    max_jerk: float = parameter(nan, "Upper bound of the jerk")
    min_jerk: float = parameter(nan, "Lower bound of the jerk; default -max_jerk")
    min_acceleration: float = parameter(nan, "Deprecated and without effect: use max_deceleration")
    has_velocity_limits: bool = parameter(
        True, "Deprecated: false removes the velocity bounds, like .nan in each"
    )
    has_acceleration_limits: bool = parameter(
        True, "Deprecated: false removes the acceleration bounds, like .nan in each"
    )
    has_jerk_limits: bool = parameter(
        True, "Deprecated: false removes the jerk bounds, like .nan in each"
    )

    def in_force(self) -> "SpeedLimits":
        """Return the limits without those that a deprecated parameter removes."""
        removed = [
            bound
            for switch, bounds in _SWITCHES.items()
            if not getattr(self, switch)
            for bound in bounds
        ]
        return replace(self, **dict.fromkeys(removed, nan))

    def deprecations(self, prefix: str) -> list[str]:
        """Return a sentence for each deprecated parameter in use; `prefix` is like 'linear.x.'."""
        sentences = [
            f"parameter '{prefix}{switch}' is deprecated: remove it, and set .nan in "
            f"{', '.join(bounds)} where there is no bound"
            for switch, bounds in _SWITCHES.items()
            if not getattr(self, switch)
        ]
        if not isnan(self.min_acceleration):
            sentences.append(
                f"parameter '{prefix}min_acceleration' is deprecated and has no effect: set "
                f"'{prefix}max_deceleration'"
            )
        return sentences

    def check(self, prefix: str) -> None:
        """Raise `ParameterError` for a bound that has the wrong sign or forbids every motion.

        `prefix` is that of the parameters' names, 'linear.x.'.
        """
        for bound in fields(self):
            if bound.name not in _BOUNDS:
                continue
            value = getattr(self, bound.name)
            is_lower = bound.name in _LOWER_BOUNDS
            if value > 0 if is_lower else value < 0:
                side = (
                    "a lower bound: it is at most 0"
                    if is_lower
                    else "an upper bound: it is at least 0"
                )
                raise ParameterError(
                    f"parameter '{prefix}{bound.name}' is {value:g}, but is {side}"
                )
            if value == 0 and bound.name in _NEVER_ZERO:
                raise ParameterError(
                    f"parameter '{prefix}{bound.name}' is 0, so the robot could never change its "
                    "speed; .nan stands for no bound"
                )


_SWITCHES = {
    "has_velocity_limits": ("max_velocity", "min_velocity"),
    "has_acceleration_limits": (
        "max_acceleration",
        "max_deceleration",
        "max_acceleration_reverse",
        "max_deceleration_reverse",
    ),
    "has_jerk_limits": ("max_jerk", "min_jerk"),
}
"""The bounds that each deprecated parameter removes."""

_BOUNDS = tuple(bound for bounds in _SWITCHES.values() for bound in bounds)
_LOWER_BOUNDS = ("min_velocity", "max_deceleration", "max_acceleration_reverse", "min_jerk")
_NEVER_ZERO = ("max_acceleration", "max_deceleration", "max_jerk", "min_jerk")


class SpeedLimiter:
    """Follows a target speed as closely as its limits allow. One thread.

    Attributes:
        speed: the last limited speed.
    """

    def __init__(self, limits: SpeedLimits, speed: float = 0.0) -> None:
        """Start at a steady speed."""
        limits = limits.in_force()
        upper = _or(limits.max_velocity, inf)
        self._velocity = (_or(limits.min_velocity, -upper), upper)
        faster = _or(limits.max_acceleration, inf)
        faster_backwards = _or(limits.max_acceleration_reverse, -faster)
        braking = _or(limits.max_deceleration, faster_backwards)
        braking_backwards = _or(limits.max_deceleration_reverse, faster)
        self._forwards = (braking, faster)
        self._backwards = (faster_backwards, braking_backwards)
        self._from_rest = (faster_backwards, faster)
        jerk = _or(limits.max_jerk, inf)
        self._jerk = (_or(limits.min_jerk, -jerk), jerk)
        self.speed = speed
        self._change = 0.0

    def save_state(self) -> tuple[float, float]:
        """Return the speed and its last change."""
        return self.speed, self._change

    def load_state(self, state: tuple[float, float]) -> None:
        """Set the speed and its last change."""
        self.speed, self._change = state

    def limit(self, wanted: float, period_s: float) -> float:
        """Return the speed for a cycle, `period_s` above 0 after the last one."""
        change = wanted - self.speed
        # The jerk of a braking robot is not limited: that would make the speed oscillate about the
        # target.
        if (change - self._change) * change > 0:
            low, high = (bound * period_s**2 for bound in self._jerk)
            change = self._change + _clamp(change - self._change, low, high)
        low, high = (bound * period_s for bound in self._rates())
        speed = _clamp(self.speed + _clamp(change, low, high), *self._velocity)
        self._change = speed - self.speed
        self.speed = speed
        return speed

    def _rates(self) -> tuple[float, float]:
        if self.speed > 0:
            return self._forwards
        return self._backwards if self.speed < 0 else self._from_rest


def _or(value: float, default: float) -> float:
    return default if isnan(value) else value


def _clamp(value: float, low: float, high: float) -> float:
    return min(max(value, low), high)


@dataclass(frozen=True, slots=True)
class _LinearLimits:
    """linear: limits of the forward velocity."""

    x: SpeedLimits = field(default_factory=SpeedLimits)


@dataclass(frozen=True, slots=True)
class _AngularLimits:
    """angular: limits of the yaw rate."""

    z: SpeedLimits = field(default_factory=SpeedLimits)


@dataclass(frozen=True, slots=True)
class DiffDriveParameters:
    """All parameters; all wheels of a side turn at the same speed."""

    left_wheel_names: tuple[str, ...] = parameter(
        (), "Joints of the left wheels", at_configuration=True
    )
    right_wheel_names: tuple[str, ...] = parameter(
        (), "Joints of the right wheels", at_configuration=True
    )
    wheel_separation: float = parameter(
        0.0, "Distance between the left and right wheels, in m", above=0.0
    )
    wheel_radius: float = parameter(0.0, "Radius of a wheel, in m", above=0.0)
    wheels_per_side: int = parameter(
        0, "Legacy parameter; the named wheels are counted", at_configuration=True
    )
    wheel_separation_multiplier: float = parameter(1.0, "Corrects wheel_separation", above=0.0)
    left_wheel_radius_multiplier: float = parameter(
        1.0, "Corrects wheel_radius on the left", above=0.0
    )
    right_wheel_radius_multiplier: float = parameter(
        1.0, "Corrects wheel_radius on the right", above=0.0
    )
    tf_frame_prefix_enable: bool = parameter(
        True,
        "Prefix the frames with tf_frame_prefix, or with the namespace if that is empty",
        at_configuration=True,
    )
    tf_frame_prefix: str = parameter(
        "", "Prefix of the frames, joined with a slash", at_configuration=True
    )
    odom_frame_id: str = parameter(
        "odom", "Frame in which the robot's pose is given", at_configuration=True
    )
    base_frame_id: str = parameter("base_link", "Frame of the robot", at_configuration=True)
    pose_covariance_diagonal: tuple[float, ...] = parameter(
        NO_COVARIANCE, "Variances of x y z roll pitch yaw", at_configuration=True
    )
    twist_covariance_diagonal: tuple[float, ...] = parameter(
        NO_COVARIANCE, "Variances of the twist: along, then about x y z", at_configuration=True
    )
    open_loop: bool = parameter(
        False, "Compute the odometry from the commands alone", at_configuration=True
    )
    position_feedback: bool = parameter(
        True, "Compute the odometry from wheel positions, not velocities", at_configuration=True
    )
    enable_odom_tf: bool = parameter(
        True, "Publish the robot's frame on /tf", at_configuration=True
    )
    cmd_vel_timeout: float = parameter(
        0.5, "Time in s after which a command expires; 0 for never", at_least=0.0
    )
    publish_limited_velocity: bool = parameter(
        False, "Publish the limited command on ~/cmd_vel_out", at_configuration=True
    )
    velocity_rolling_window_size: int = parameter(
        10, "Cycles over which the speeds are averaged", at_configuration=True, above=0
    )
    publish_rate: float = parameter(50.0, "Publish rate of the odometry, in Hz", above=0)
    linear: _LinearLimits = field(default_factory=_LinearLimits)
    angular: _AngularLimits = field(default_factory=_AngularLimits)

    @property
    def geometry(self) -> WheelGeometry:
        """The wheel geometry, with the multipliers applied."""
        return WheelGeometry(
            self.wheel_separation * self.wheel_separation_multiplier,
            self.wheel_radius * self.left_wheel_radius_multiplier,
            self.wheel_radius * self.right_wheel_radius_multiplier,
        )

    def deprecations(self) -> list[str]:
        """Return a sentence for each deprecated parameter that is used."""
        return [
            *self.linear.x.deprecations("linear.x."),
            *self.angular.z.deprecations("angular.z."),
        ]

    def frame(self, name: str, namespace: str) -> str:
        """Return a frame's full name for a controller in a namespace."""
        prefix = (
            (self.tf_frame_prefix or namespace).strip("/") if self.tf_frame_prefix_enable else ""
        )
        return f"{prefix}/{name}" if prefix else name

    def check_together(self) -> None:
        """Raise `ParameterError` if a value or the bounds of a speed are invalid."""
        check_values(self, specs_of(DiffDriveParameters))
        self.linear.x.check("linear.x.")
        self.angular.z.check("angular.z.")

    def check_robot(self) -> None:
        """Raise `ControllerError` if the robot could not drive; called at the configuration.

        Before that, clients may change the names of the wheels one after the other.
        """
        left, right = self.left_wheel_names, self.right_wheel_names
        if not left or len(left) != len(right):
            raise ControllerError(
                "parameters 'left_wheel_names' and 'right_wheel_names' must name the same number "
                f"of wheels, at least one each; they name {len(left)} and {len(right)}"
            )
        if self.wheels_per_side not in (0, len(left)):
            raise ControllerError(
                f"parameter 'wheels_per_side' is {self.wheels_per_side}, but {len(left)} wheels "
                "are named on each side"
            )
        check_covariances(self.pose_covariance_diagonal, self.twist_covariance_diagonal)
