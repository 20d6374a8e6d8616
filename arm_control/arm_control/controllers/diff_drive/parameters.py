"""Parameters of diff_drive_controller/DiffDriveController."""

from dataclasses import dataclass, field

from arm_control.controllers.diff_drive.odometry import WheelGeometry
from arm_control.controllers.diff_drive.speed_limits import SpeedLimits
from arm_control.controllers.drive import NO_COVARIANCE, check_covariances
from arm_control.errors import ControllerError
from arm_control.parameters import check_values, parameter, specs_of


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
