"""Parameters of diff_drive_controller/DiffDriveController."""

from dataclasses import dataclass, field

from arm_control.diff_drive.speed_limits import SpeedLimits
from arm_control.diff_drive.wheel_geometry import WheelGeometry
from arm_control.errors import ParameterError
from arm_control.parameters import parameter

DIAGONAL = 6


@dataclass(frozen=True, slots=True)
class LinearLimits:
    """linear: of the speed forwards."""

    x: SpeedLimits = field(default_factory=SpeedLimits)


@dataclass(frozen=True, slots=True)
class AngularLimits:
    """angular: of the speed of turning."""

    z: SpeedLimits = field(default_factory=SpeedLimits)


@dataclass(frozen=True, slots=True)
class DiffDriveParameters:
    """All parameters; the wheels of a side turn alike."""

    left_wheel_names: tuple[str, ...] = parameter((), "Joints of the left wheels", read_only=True)
    right_wheel_names: tuple[str, ...] = parameter((), "Joints of the right wheels", read_only=True)
    wheel_separation: float = parameter(0.0, "Between left and right wheels, in m")
    wheel_radius: float = parameter(0.0, "Of a wheel, in m")
    wheels_per_side: int = parameter(
        0, "Known from older versions; the wheels named are counted", read_only=True
    )
    wheel_separation_multiplier: float = parameter(1.0, "Corrects wheel_separation")
    left_wheel_radius_multiplier: float = parameter(1.0, "Corrects wheel_radius on the left")
    right_wheel_radius_multiplier: float = parameter(1.0, "Corrects wheel_radius on the right")
    tf_frame_prefix_enable: bool = parameter(
        True,
        "Put tf_frame_prefix before the frames, or the namespace if that is empty",
        read_only=True,
    )
    tf_frame_prefix: str = parameter("", "Put before the frames, with a slash", read_only=True)
    odom_frame_id: str = parameter("odom", "Frame in which the robot is located", read_only=True)
    base_frame_id: str = parameter("base_link", "Frame of the robot", read_only=True)
    pose_covariance_diagonal: tuple[float, ...] = parameter(
        (0.0,) * DIAGONAL, "Of x y z roll pitch yaw", read_only=True
    )
    twist_covariance_diagonal: tuple[float, ...] = parameter(
        (0.0,) * DIAGONAL, "Of the speeds along and about x y z", read_only=True
    )
    open_loop: bool = parameter(False, "Locate the robot by its commands alone", read_only=True)
    position_feedback: bool = parameter(
        True, "Locate it by the wheels' positions, not by their velocities", read_only=True
    )
    enable_odom_tf: bool = parameter(True, "Publish the robot's frame on /tf", read_only=True)
    cmd_vel_timeout: float = parameter(0.5, "In s, after which a command is void; 0: never")
    publish_limited_velocity: bool = parameter(
        False, "Publish on ~/cmd_vel_out what the limits leave of a command", read_only=True
    )
    velocity_rolling_window_size: int = parameter(
        10, "Cycles over which the speeds are averaged", read_only=True, above=0
    )
    publish_rate: float = parameter(50.0, "Of the odometry, in Hz", above=0)
    linear: LinearLimits = field(default_factory=LinearLimits)
    angular: AngularLimits = field(default_factory=AngularLimits)

    @property
    def geometry(self) -> WheelGeometry:
        """The sizes, corrected."""
        return WheelGeometry(
            self.wheel_separation * self.wheel_separation_multiplier,
            self.wheel_radius * self.left_wheel_radius_multiplier,
            self.wheel_radius * self.right_wheel_radius_multiplier,
        )

    def frame(self, name: str, namespace: str) -> str:
        """Return a frame's full name for a controller in a namespace."""
        prefix = (
            (self.tf_frame_prefix or namespace).strip("/") if self.tf_frame_prefix_enable else ""
        )
        return f"{prefix}/{name}" if prefix else name

    def check(self) -> None:
        """Raise `ParameterError` where the robot could not drive, or values contradict."""
        left, right = self.left_wheel_names, self.right_wheel_names
        if not left or len(left) != len(right):
            raise ParameterError(
                "parameters 'left_wheel_names' and 'right_wheel_names' take equally many wheels, "
                f"at least one each; they have {len(left)} and {len(right)}"
            )
        if self.wheels_per_side not in (0, len(left)):
            raise ParameterError(
                f"parameter 'wheels_per_side' is {self.wheels_per_side}, but {len(left)} wheels "
                "are named on each side"
            )
        for name in ("wheel_separation", "wheel_radius"):
            self._check_positive(name)
        for name in ("wheel_separation", "left_wheel_radius", "right_wheel_radius"):
            self._check_positive(f"{name}_multiplier")
        if not self.cmd_vel_timeout >= 0:
            raise ParameterError(
                f"parameter 'cmd_vel_timeout' must not be negative, but is {self.cmd_vel_timeout:g}"
            )
        for name in ("pose_covariance_diagonal", "twist_covariance_diagonal"):
            if len(getattr(self, name)) != DIAGONAL:
                raise ParameterError(
                    f"parameter '{name}' takes {DIAGONAL} numbers, not {len(getattr(self, name))}"
                )
        self.linear.x.check("linear.x.")
        self.angular.z.check("angular.z.")

    def _check_positive(self, name: str) -> None:
        value = getattr(self, name)
        if not value > 0:
            raise ParameterError(f"parameter '{name}' must be above 0, but is {value:g}")
