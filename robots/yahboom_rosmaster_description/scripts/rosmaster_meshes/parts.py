"""All parts of the robot."""

from arm_meshes.part import Part

from rosmaster_meshes.chassis import chassis
from rosmaster_meshes.sensors import camera, imu, lidar
from rosmaster_meshes.wheel import wheel


def all_parts() -> tuple[Part, ...]:
    """Return every part, each named after its link."""
    wheels = [wheel(end, side) for end in ("front", "back") for side in ("left", "right")]
    return (chassis(), *wheels, camera(), lidar(), imu())
