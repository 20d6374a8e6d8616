"""diff_drive_controller/DiffDriveController: drives a robot on two rows of wheels."""

from arm_control.diff_drive.diff_drive_controller import DiffDriveController, DriveSink
from arm_control.diff_drive.odometry import Odometry
from arm_control.diff_drive.parameters import DiffDriveParameters
from arm_control.diff_drive.planar_pose import PlanarPose
from arm_control.diff_drive.planar_twist import PlanarTwist
from arm_control.diff_drive.speed_limiter import SpeedLimiter
from arm_control.diff_drive.speed_limits import SpeedLimits
from arm_control.diff_drive.wheel_geometry import WheelGeometry

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
