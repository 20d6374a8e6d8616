"""diff_drive_controller/DiffDriveController: from a robot's speeds to its wheels', and back."""

from collections import deque
from collections.abc import Mapping
from dataclasses import dataclass
from math import isfinite
from typing import Any, Protocol

import numpy as np

from arm_control.chainable_controller import ChainableController
from arm_control.controller import ControllerContext, ReturnType
from arm_control.diff_drive.odometry import Odometry
from arm_control.diff_drive.parameters import DiffDriveParameters
from arm_control.diff_drive.planar_pose import PlanarPose
from arm_control.diff_drive.planar_twist import PlanarTwist
from arm_control.diff_drive.publish_schedule import PublishSchedule
from arm_control.diff_drive.speed_limiter import SpeedLimiter
from arm_control.interface_configuration import InterfaceConfiguration
from arm_control.parameters import build_parameters

STANDSTILL = PlanarTwist()
REFERENCES = ("linear/velocity", "angular/velocity")


class DriveSink(Protocol):
    """Where the controller's results go; used on the loop thread."""

    def publish_odometry(self, time_s: float, pose: PlanarPose, twist: PlanarTwist) -> None:
        """Publish where the robot is and how fast it goes."""
        ...

    def publish_command(self, time_s: float, twist: PlanarTwist) -> None:
        """Publish the speeds that are commanded, within their limits; in every cycle."""
        ...


@dataclass(frozen=True, slots=True)
class _Command:
    """A wish and when it was one."""

    twist: PlanarTwist
    stamp_s: float


class DiffDriveController(ChainableController[DiffDriveParameters]):
    """Turns the wheels of both sides so that the robot moves at its references.

    The references are a speed forwards in m/s and one of turning in rad/s; while one is NaN, the
    wheels are left as they are. The pose is lost at `on_configure`, not at activation.

    Attributes:
        sink: where the results go; None publishes nothing. Set it before activation.
    """

    parameters_type = DiffDriveParameters
    adapter = "arm_control.ros.diff_drive_adapter:DiffDriveAdapter"

    def __init__(self, context: ControllerContext) -> None:
        super().__init__(context)
        self.sink: DriveSink | None = None
        self._offered: deque[_Command] = deque(maxlen=1)
        self._command = _Command(STANDSTILL, 0.0)
        self._now_s: float | None = None
        self._odometry = Odometry()
        self._last_angles: np.ndarray | None = None

    @classmethod
    def build_parameters(cls, values: Mapping[str, Any]) -> DiffDriveParameters:
        """Return the values as one object, checked."""
        parameters = build_parameters(DiffDriveParameters, values)
        parameters.check()
        return parameters

    def on_configure(self, parameters: DiffDriveParameters) -> None:
        """Take the parameters; the robot is at the origin."""
        super().on_configure(parameters)
        # A mean would only delay what is known exactly.
        window = 1 if parameters.open_loop else parameters.velocity_rolling_window_size
        self._odometry = Odometry(window)
        self._take(parameters)

    def update_parameters(self, parameters: DiffDriveParameters) -> None:
        """Take changed sizes, limits and rates; new limits begin at the present speed."""
        super().update_parameters(parameters)
        self._take(parameters, self._limited)

    def command_interface_configuration(self) -> InterfaceConfiguration:
        """Claim the velocity of each wheel, the left ones first."""
        return InterfaceConfiguration.individual(f"{wheel}/velocity" for wheel in self._wheels)

    def state_interface_configuration(self) -> InterfaceConfiguration:
        """Read what each wheel did, unless the robot is located by commands."""
        if self.parameters.open_loop:
            return InterfaceConfiguration.none()
        feedback = "position" if self.parameters.position_feedback else "velocity"
        return InterfaceConfiguration.individual(f"{wheel}/{feedback}" for wheel in self._wheels)

    def reference_names(self) -> tuple[str, ...]:
        """Export the robot's two speeds."""
        return REFERENCES

    def offer(self, twist: PlanarTwist, stamp_s: float | None) -> str:
        """Drive at these speeds from the next cycle on, until the time-out; any thread.

        Args:
            twist: the speeds.
            stamp_s: when that was wished, in the controller's time; None for now. So is a time
                to come: it is that of another clock, and would put off the time-out.

        Returns:
            Why it was refused; empty where it was taken.
        """
        now_s = self._now_s
        if now_s is None:
            return "the controller is not active"
        if self.is_chained:
            return "another controller commands this one"
        if not all(map(isfinite, self._geometry.wheel_speeds(twist))):
            return f"no wheel can turn at its speeds, {twist.linear} m/s and {twist.angular} rad/s"
        stamp_s = now_s if stamp_s is None else min(stamp_s, now_s)
        timeout_s = self.parameters.cmd_vel_timeout
        if timeout_s and now_s - stamp_s > timeout_s:
            return (
                f"its stamp is {now_s - stamp_s:.3f} s old, and cmd_vel_timeout is {timeout_s:g} s"
            )
        self._offered.append(_Command(twist, stamp_s))
        return ""

    def on_activate(self) -> None:
        """Begin at a standstill, where the robot was last."""
        self._forget_commands()
        self._take(self.parameters)
        self._last_angles = None
        self._odometry.halt()
        self.commands.write(0.0)

    def on_set_chained_mode(self, is_chained: bool) -> None:
        """Drop what was offered: it is of another time."""
        self._forget_commands()

    def on_deactivate(self) -> None:
        """Stop the wheels."""
        self._now_s = None
        self._forget_commands()
        self.commands.write(0.0)

    def update_references(self, time_s: float, period_s: float) -> ReturnType:
        """Take what was offered; what is too old counts as a wish to stand still."""
        if self._offered:
            self._command = self._offered.pop()
        age_s = time_s - self._command.stamp_s
        timeout_s = self.parameters.cmd_vel_timeout
        # An age below 0: the clock was set back.
        is_valid = age_s >= 0 and (not timeout_s or age_s <= timeout_s)
        twist = self._command.twist if is_valid else STANDSTILL
        self.references[:] = twist.linear, twist.angular
        return ReturnType.OK

    def update_commands(self, time_s: float, period_s: float) -> ReturnType:
        """Locate the robot by what its wheels did, then command them."""
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
        """What is commanded."""
        return PlanarTwist(self._linear.speed, self._angular.speed)

    def _take(self, parameters: DiffDriveParameters, speeds: PlanarTwist = STANDSTILL) -> None:
        self._geometry = parameters.geometry
        self._linear = SpeedLimiter(parameters.linear.x, speeds.linear)
        self._angular = SpeedLimiter(parameters.angular.z, speeds.angular)
        self._schedule = PublishSchedule(parameters.publish_rate)
        self._speeds = np.zeros((2, len(parameters.left_wheel_names)))

    def _motion(self, period_s: float) -> tuple[float, float] | None:
        """Return distance and turn since the last cycle; None, and say so, if a wheel is lost."""
        if self.parameters.open_loop:
            return self._linear.speed * period_s, self._angular.speed * period_s
        sides = self.states.read().reshape(2, -1).mean(axis=1)
        if not np.isfinite(sides).all():
            lost = [
                name
                for name, value in zip(self.states.names, self.states.read(), strict=True)
                if not np.isfinite(value)
            ]
            self.logger.error("the robot cannot be located: %s is no number", ", ".join(lost))
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

    def _forget_commands(self) -> None:
        self._offered.clear()
        self._command = _Command(STANDSTILL, 0.0)
