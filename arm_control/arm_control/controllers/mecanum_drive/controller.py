"""mecanum_drive_controller/MecanumDriveController: drives a robot with four mecanum wheels."""

from dataclasses import dataclass, field
from math import nan
from typing import Any, Protocol

import numpy as np

from arm_control.controllers.controller import ControllerContext, InterfaceConfiguration, ReturnType
from arm_control.controllers.drive import NO_COVARIANCE, DriveController, check_covariances
from arm_control.controllers.mecanum_drive.kinematics import (
    WHEELS,
    Array,
    MecanumGeometry,
    MecanumOdometry,
    MecanumTwist,
)
from arm_control.errors import ControllerError
from arm_control.parameters import check_values, parameter, specs_of

REFERENCES = ("linear/x/velocity", "linear/y/velocity", "angular/z/velocity")
STANDSTILL = MecanumTwist()
NO_REFERENCE = (nan, nan, nan)


@dataclass(frozen=True, slots=True)
class _BaseFrameOffset:
    """kinematics.base_frame_offset: pose of the base frame relative to the centre of the wheels."""

    x: float = parameter(0.0, "x of the base frame in the centre frame, in m", read_only=True)
    y: float = parameter(0.0, "y of the base frame in the centre frame, in m", read_only=True)
    theta: float = parameter(
        0.0, "Orientation of the base frame in the centre frame, in rad", read_only=True
    )


@dataclass(frozen=True, slots=True)
class _Kinematics:
    """kinematics: sizes of the base."""

    base_frame_offset: _BaseFrameOffset = field(default_factory=_BaseFrameOffset)
    wheels_radius: float = parameter(0.0, "Radius of the wheels, in m", above=0.0)
    sum_of_robot_center_projection_on_X_Y_axis: float = parameter(
        0.0, "Distance of a wheel from the centre along x plus that along y, in m", above=0.0
    )


def _wheel(which: str, kind: str) -> Any:
    default = "; empty: the commanded joint" if kind == "state" else ""
    return parameter("", f"Joint of the {which} wheel ({kind} interface){default}", read_only=True)


@dataclass(frozen=True, slots=True)
class MecanumDriveParameters:
    """All parameters of the controller."""

    reference_timeout: float = parameter(
        0.0,
        "Time in s after which a reference counts as a standstill; 0: each is used for one cycle",
        at_least=0.0,
    )
    front_left_wheel_command_joint_name: str = _wheel("front left", "command")
    front_right_wheel_command_joint_name: str = _wheel("front right", "command")
    rear_right_wheel_command_joint_name: str = _wheel("rear right", "command")
    rear_left_wheel_command_joint_name: str = _wheel("rear left", "command")
    front_left_wheel_state_joint_name: str = _wheel("front left", "state")
    front_right_wheel_state_joint_name: str = _wheel("front right", "state")
    rear_right_wheel_state_joint_name: str = _wheel("rear right", "state")
    rear_left_wheel_state_joint_name: str = _wheel("rear left", "state")
    kinematics: _Kinematics = field(default_factory=_Kinematics)
    base_frame_id: str = parameter("base_link", "Frame of the robot", at_configuration=True)
    odom_frame_id: str = parameter("odom", "Frame of the odometry", at_configuration=True)
    enable_odom_tf: bool = parameter(
        True, "Publish the transform from odom_frame_id to base_frame_id", at_configuration=True
    )
    pose_covariance_diagonal: tuple[float, ...] = parameter(
        NO_COVARIANCE, "Variances of x y z roll pitch yaw", at_configuration=True
    )
    twist_covariance_diagonal: tuple[float, ...] = parameter(
        NO_COVARIANCE, "Variances of the velocities along and about x y z", at_configuration=True
    )

    @property
    def command_joints(self) -> tuple[str, ...]:
        """The commanded joints in the order of `WHEELS`."""
        return tuple(getattr(self, f"{wheel}_wheel_command_joint_name") for wheel in WHEELS)

    @property
    def state_joints(self) -> tuple[str, ...]:
        """The joints that are read, in the order of `WHEELS`."""
        return tuple(
            getattr(self, f"{wheel}_wheel_state_joint_name") or commanded
            for wheel, commanded in zip(WHEELS, self.command_joints, strict=True)
        )

    @property
    def geometry(self) -> MecanumGeometry:
        """The sizes in one object."""
        sizes, offset = self.kinematics, self.kinematics.base_frame_offset
        return MecanumGeometry(
            sizes.wheels_radius,
            sizes.sum_of_robot_center_projection_on_X_Y_axis,
            offset.x,
            offset.y,
            offset.theta,
        )

    def check_together(self) -> None:
        """Raise `ParameterError` if a value, which may be a default, is out of its range."""
        check_values(self, specs_of(MecanumDriveParameters))

    def check_robot(self) -> None:
        """Raise `ControllerError` if a wheel has no joint or a covariance has the wrong length."""
        for wheel, joint in zip(WHEELS, self.command_joints, strict=True):
            if not joint:
                raise ControllerError(
                    f"parameter '{wheel}_wheel_command_joint_name' is empty; "
                    "it takes the joint of that wheel"
                )
        if len(set(self.command_joints)) < len(WHEELS):
            raise ControllerError(
                f"the four wheels need four joints, but they are {', '.join(self.command_joints)}"
            )
        check_covariances(self.pose_covariance_diagonal, self.twist_covariance_diagonal)


class MecanumSink(Protocol):
    """Receives the controller's results on the loop thread."""

    def publish(
        self, time_s: float, odometry: MecanumOdometry, wheels: Array, reference: MecanumTwist
    ) -> None:
        """Publish one cycle.

        The measured velocities of the wheels, in rad/s, shape (4,), are in the order of `WHEELS`;
        the reference is NaN if there is none.
        """
        ...


class MecanumDriveController(DriveController[MecanumDriveParameters, MecanumTwist]):
    """Turns four mecanum wheels so that the robot moves at its reference twist.

    The references are the velocities along x and y in m/s and the yaw rate in rad/s; while one of
    them is NaN, the wheels stand still. `on_configure` resets the odometry; activation does not.

    Attributes:
        sink: receives the results; None publishes nothing. Set it before activation.
    """

    parameters_type = MecanumDriveParameters
    adapter = "arm_control.controllers.mecanum_drive.ros:MecanumDriveAdapter"
    transient = ("_geometry",)
    twist_type = MecanumTwist
    timeout_parameter = "reference_timeout"

    def __init__(self, context: ControllerContext) -> None:
        super().__init__(context)
        self.sink: MecanumSink | None = None
        self._odometry = MecanumOdometry()

    def on_configure(self, parameters: MecanumDriveParameters) -> None:
        """Take the parameters and set the pose to the origin.

        Raises:
            ControllerError: a wheel has no joint.
        """
        parameters.check_robot()
        super().on_configure(parameters)
        self._odometry = MecanumOdometry()
        self._geometry = parameters.geometry

    def update_parameters(self, parameters: MecanumDriveParameters) -> None:
        """Take changed sizes and the timeout."""
        super().update_parameters(parameters)
        self._geometry = parameters.geometry

    def command_interface_configuration(self) -> InterfaceConfiguration:
        """Claim the velocity of each wheel, in the order of `WHEELS`."""
        return InterfaceConfiguration.individual(
            f"{joint}/velocity" for joint in self.parameters.command_joints
        )

    def state_interface_configuration(self) -> InterfaceConfiguration:
        """Read the velocity of each wheel."""
        return InterfaceConfiguration.individual(
            f"{joint}/velocity" for joint in self.parameters.state_joints
        )

    def reference_names(self) -> tuple[str, ...]:
        """Export the three components of the twist."""
        return REFERENCES

    def reason_to_refuse(self, twist: MecanumTwist) -> str:
        """Return why no velocities of the wheels give this twist; empty if some do."""
        if np.isfinite(self._geometry.wheel_velocities(twist)).all():
            return ""
        return f"its velocities are x {twist.x}, y {twist.y} and yaw {twist.yaw}, not finite"

    def on_activate(self) -> None:
        """Start at rest, at the last pose."""
        self._forget_commands()
        self._odometry.twist = STANDSTILL
        self.references[:] = NO_REFERENCE
        self.commands.write(0.0)

    def on_reset(self) -> None:
        """Start at rest, at the origin."""
        self._odometry = MecanumOdometry()
        self.on_activate()

    def update_references(self, time_s: float, period_s: float) -> ReturnType:
        """Take the latest reference; one that is too old counts as zero."""
        reference, timeout_s = self._latest_command(), self.parameters.reference_timeout
        twist: tuple[float, float, float] = NO_REFERENCE
        if reference is not None:
            # A negative age means that the clock was set back.
            is_valid = not timeout_s or 0 <= time_s - reference.stamp_s <= timeout_s
            wanted = reference.twist if is_valid else STANDSTILL
            twist = wanted.x, wanted.y, wanted.yaw
            if not timeout_s or not is_valid:
                self._command = None
        self.references[:] = twist
        return ReturnType.OK

    def update_commands(self, time_s: float, period_s: float) -> ReturnType:
        """Update the odometry from the wheels, then command them."""
        self._now_s = time_s
        wheels = self.states.read()
        if not np.isfinite(wheels).all():
            unknown = ", ".join(self.states.unknown_names())
            self.logger.error("the odometry cannot be updated: %s is not a number", unknown)
            return ReturnType.ERROR
        self._odometry.move(self._geometry.twist(wheels), period_s)
        reference = MecanumTwist(*self.references.tolist())
        if reference.is_finite:
            self.commands.write(self._geometry.wheel_velocities(reference))
        else:
            self.commands.write(0.0)
        if self.sink is not None:
            self.sink.publish(time_s, self._odometry, wheels, reference)
        return ReturnType.OK
