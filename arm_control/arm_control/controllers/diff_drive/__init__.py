"""diff_drive_controller/DiffDriveController: drives a robot with two rows of wheels."""

from arm_control.controllers.diff_drive.controller import DiffDriveController, DriveSink
from arm_control.controllers.diff_drive.odometry import (
    Odometry,
    PlanarPose,
    PlanarTwist,
    WheelGeometry,
)
from arm_control.controllers.diff_drive.parameters import (
    DiffDriveParameters,
    SpeedLimiter,
    SpeedLimits,
)

__all__ = [
    "DiffDriveController",
    "DiffDriveParameters",
    "DriveSink",
    "Odometry",
    "PlanarPose",
    "PlanarTwist",
    "SpeedLimiter",
    "SpeedLimits",
    "WheelGeometry",
]
