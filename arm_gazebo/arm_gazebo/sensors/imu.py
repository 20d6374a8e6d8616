"""An inertial measurement unit: orientation, angular velocity, specific force."""

from collections.abc import Sequence
from typing import ClassVar

import mujoco
import numpy as np
from numpy.typing import NDArray

from arm_control.controllers.sensor_broadcasters.readings import IMU_INTERFACES
from arm_description.urdf.robot import Robot
from arm_gazebo.sensors.link_sensor import LinkSensor, Measurement, SensorTopic
from arm_gazebo.sensors.noise import SILENT, NoiseModel, read_noise
from arm_gazebo.sensors.tags import SensorTags
from arm_node.frozen import frozen

XYZW = [1, 2, 3, 0, *range(4, 10)]
"""MuJoCo puts a quaternion's scalar first, ROS puts it last."""
AXES = ("x", "y", "z")
QUIET = (SILENT,) * 3
UNKNOWN = -1.0
"""First number of the covariance of a quantity that the message does not contain."""


@frozen
class ImuSensor(LinkSensor):
    """An IMU.

    It measures the orientation of its axes in the world (x east, z up: REP 103), and in its own
    axes the angular velocity and the specific force: at rest +9.81 m/s2 upwards.

    Attributes:
        angular_velocity_noise: noise along x, y, z, in rad/s.
        linear_acceleration_noise: noise along x, y, z, in m/s2.
        has_orientation: whether it reports its orientation.
    """

    angular_velocity_noise: tuple[NoiseModel, ...] = QUIET
    linear_acceleration_noise: tuple[NoiseModel, ...] = QUIET
    has_orientation: bool = True

    type: ClassVar[str] = "imu"
    channels: ClassVar[tuple[str, ...]] = IMU_INTERFACES

    @classmethod
    def read(cls, tags: SensorTags, robot: Robot) -> "ImuSensor":
        """Return the sensor that the tags describe.

        Raises:
            SensorError: a value is invalid.
        """
        pose = tags.pose()
        return cls(
            name=tags.name,
            link=tags.reference,
            frame_id=tags.frame(tags.reference),
            topic=tags.own_topics()[0],
            rate_hz=tags.rate_hz(),
            xyz=(pose[0], pose[1], pose[2]),
            rpy=(pose[3], pose[4], pose[5]),
            angular_velocity_noise=_noise(tags, "angular_velocity"),
            linear_acceleration_noise=_noise(tags, "linear_acceleration"),
            has_orientation=tags.choice("enable_orientation", ("true", "1", "false", "0"))
            in ("true", "1"),
        )

    @property
    def noise(self) -> tuple[NoiseModel, ...]:
        """The noise of each channel; the orientation has none."""
        return (*(SILENT,) * 4, *self.angular_velocity_noise, *self.linear_acceleration_noise)

    def topics(self) -> Sequence[SensorTopic]:
        """Return the topic of the readings, with the covariances that follow from the noise."""
        fields = ("orientation", "angular_velocity", "linear_acceleration")
        covariances = {
            "angular_velocity_covariance": _covariance(self.angular_velocity_noise),
            "linear_acceleration_covariance": _covariance(self.linear_acceleration_noise),
        }
        if self.has_orientation:
            return (SensorTopic("sensor_msgs/msg/Imu", fields, constants=covariances),)
        covariances["orientation_covariance"] = (UNKNOWN, *(0.0,) * 8)
        return (SensorTopic("sensor_msgs/msg/Imu", fields[1:], first=4, constants=covariances),)

    def measurements(self) -> Sequence[Measurement]:
        """Return the measurements of orientation, angular velocity and specific force."""
        kinds = {
            "orientation": mujoco.mjtSensor.mjSENS_FRAMEQUAT,
            "angular_velocity": mujoco.mjtSensor.mjSENS_GYRO,
            "linear_acceleration": mujoco.mjtSensor.mjSENS_ACCELEROMETER,
        }
        site = mujoco.mjtObj.mjOBJ_SITE
        return [Measurement(name, kind, site, self.key) for name, kind in kinds.items()]

    def reading(self, measured: NDArray[np.float64], state: mujoco.MjData) -> NDArray[np.float64]:
        """Return the channels."""
        return measured[XYZW]


def _covariance(noise: tuple[NoiseModel, ...]) -> tuple[float, ...]:
    return tuple(np.diag([model.stddev**2 for model in noise]).ravel().tolist())


def _noise(tags: SensorTags, vector: str) -> tuple[NoiseModel, ...]:
    return tuple(read_noise(tags, f"{vector}/{axis}") for axis in AXES)
