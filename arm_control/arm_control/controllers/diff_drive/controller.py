"""diff_drive_controller/DiffDriveController: drives a robot with two rows of wheels."""

from math import inf, isfinite
from typing import Protocol

import numpy as np

from arm_control.controllers.controller import ControllerContext, InterfaceConfiguration, ReturnType
from arm_control.controllers.diff_drive.odometry import Odometry, PlanarPose, PlanarTwist
from arm_control.controllers.diff_drive.parameters import DiffDriveParameters, SpeedLimiter
from arm_control.controllers.drive import DriveController
from arm_control.loop.schedule import Schedule

STANDSTILL = PlanarTwist()
REFERENCES = ("linear/velocity", "angular/velocity")


class DriveSink(Protocol):
    """Receives the controller's results on the loop thread."""

    def publish_odometry(self, time_s: float, pose: PlanarPose, twist: PlanarTwist) -> None:
        """Publish the pose and the twist of the robot."""
        ...

    def publish_command(self, time_s: float, twist: PlanarTwist) -> None:
        """Publish the limited twist that is commanded; called in every cycle."""
        ...


class DiffDriveController(DriveController[DiffDriveParameters, PlanarTwist]):
    """Turns the wheels so that the robot moves at its reference twist.

    The references are the linear velocity in m/s and the angular velocity in rad/s; while one is
    NaN, the wheel commands are unchanged. `on_configure` resets the pose; activation does not.

    Attributes:
        sink: receives the results; None publishes nothing. Set it before activation.
    """

    parameters_type = DiffDriveParameters
    adapter = "arm_control.controllers.diff_drive.ros:DiffDriveAdapter"
    transient = ("_geometry",)
    twist_type = PlanarTwist
    timeout_parameter = "cmd_vel_timeout"

    def __init__(self, context: ControllerContext) -> None:
        super().__init__(context)
        self.sink: DriveSink | None = None
        self._odometry = Odometry()
        self._last_angles: np.ndarray | None = None

    def on_configure(self, parameters: DiffDriveParameters) -> None:
        """Take the parameters and reset the pose to the origin.

        Raises:
            ControllerError: the robot could not drive with these parameters.
        """
        parameters.check_robot()
        for sentence in parameters.deprecations():
            self.logger.warning("%s", sentence)
        super().on_configure(parameters)
        # Averaging would only delay a twist that is known exactly.
        window = 1 if parameters.open_loop else parameters.velocity_rolling_window_size
        self._odometry = Odometry(window)
        self._take(parameters)

    def update_parameters(self, parameters: DiffDriveParameters) -> None:
        """Apply changed sizes, limits and rates; new limits start at the current speed."""
        super().update_parameters(parameters)
        self._take(parameters, self._limited)

    def command_interface_configuration(self) -> InterfaceConfiguration:
        """Claim the velocity of each wheel, left wheels first."""
        return InterfaceConfiguration.individual(f"{wheel}/velocity" for wheel in self._wheels)

    def state_interface_configuration(self) -> InterfaceConfiguration:
        """Read the feedback of each wheel, unless odometry is open-loop."""
        if self.parameters.open_loop:
            return InterfaceConfiguration.none()
        feedback = "position" if self.parameters.position_feedback else "velocity"
        return InterfaceConfiguration.individual(f"{wheel}/{feedback}" for wheel in self._wheels)

    def reference_names(self) -> tuple[str, ...]:
        """Export the linear and the angular velocity."""
        return REFERENCES

    def reason_to_refuse(self, twist: PlanarTwist) -> str:
        """Return why no speeds of the wheels give this twist; empty if some do."""
        if all(map(isfinite, self._geometry.wheel_speeds(twist))):
            return ""
        return f"no wheel speed gives {twist.linear} m/s and {twist.angular} rad/s"

    def on_activate(self) -> None:
        """Start at rest, at the last pose."""
        self._forget_commands()
        self._take(self.parameters)
        self._last_angles = None
        self._odometry.halt()
        self.commands.write(0.0)

    def on_reset(self) -> None:
        """Start at rest, at the origin."""
        self._odometry.pose = PlanarPose()
        self.on_activate()

    def update_references(self, time_s: float, period_s: float) -> ReturnType:
        """Take the latest command; one that is too old counts as zero."""
        command, timeout_s = self._latest_command(), self.parameters.cmd_vel_timeout
        twist = STANDSTILL
        # An age below 0 means that the clock was set back.
        if command is not None and 0 <= time_s - command.stamp_s <= (timeout_s or inf):
            twist = command.twist
        self.references[:] = twist.linear, twist.angular
        return ReturnType.OK

    def update_commands(self, time_s: float, period_s: float) -> ReturnType:
        """Update the odometry from the wheels, then command them."""
        self._now_s = time_s
        motion = self._motion(period_s)
        if motion is None:
            return ReturnType.ERROR
        self._odometry.move(*motion, period_s)
        wanted = PlanarTwist(*self.references.tolist())
        if wanted.is_finite:
            self._linear.limit(wanted.linear, period_s)
            self._angular.limit(wanted.angular, period_s)
            self._speeds[:, :] = np.array(self._geometry.wheel_speeds(self._limited))[:, None]
            self.commands.write(self._speeds.ravel())
        self._publish(time_s)
        return ReturnType.OK

    @property
    def _wheels(self) -> tuple[str, ...]:
        return (*self.parameters.left_wheel_names, *self.parameters.right_wheel_names)

    @property
    def _limited(self) -> PlanarTwist:
        """The commanded twist, within its limits."""
        return PlanarTwist(self._linear.speed, self._angular.speed)

    def _take(self, parameters: DiffDriveParameters, speeds: PlanarTwist = STANDSTILL) -> None:
        self._geometry = parameters.geometry
        self._linear = SpeedLimiter(parameters.linear.x, speeds.linear)
        self._angular = SpeedLimiter(parameters.angular.z, speeds.angular)
        self._schedule = Schedule(parameters.publish_rate)
        self._speeds = np.zeros((2, len(parameters.left_wheel_names)))

    def _motion(self, period_s: float) -> tuple[float, float] | None:
        """Return distance and turn since the last cycle; log and return None if one is NaN."""
        if self.parameters.open_loop:
            return self._linear.speed * period_s, self._angular.speed * period_s
        sides = self.states.read().reshape(2, -1).mean(axis=1)
        if not np.isfinite(sides).all():
            unknown = ", ".join(self.states.unknown_names())
            self.logger.error("the odometry cannot be updated: %s is not a number", unknown)
            return None
        if self.parameters.position_feedback:
            last = sides if self._last_angles is None else self._last_angles
            self._last_angles, turned = sides, sides - last
        else:
            turned = sides * period_s
        return self._geometry.motion(float(turned[0]), float(turned[1]))

    def _publish(self, time_s: float) -> None:
        if self.sink is None:
            return
        if self._schedule.is_due(time_s):
            self.sink.publish_odometry(time_s, self._odometry.pose, self._odometry.twist)
        if self.parameters.publish_limited_velocity:
            self.sink.publish_command(time_s, self._limited)
