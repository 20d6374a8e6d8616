"""A force-torque sensor: what a joint passes on between its two links."""

from collections.abc import Sequence
from dataclasses import dataclass
from typing import ClassVar

import mujoco
import numpy as np
from numpy.typing import NDArray

from arm_control.sensor_interfaces import FORCE_TORQUE_INTERFACES
from arm_description.robot import Joint
from arm_gazebo.sensors.link_sensor import LinkSensor, Measurement
from arm_gazebo.sensors.noise import SILENT, NoiseModel, read_noise
from arm_gazebo.sensors.tags import SensorTags

FRAMES = ("child", "parent", "sensor")
DIRECTIONS = ("child_to_parent", "parent_to_child")
QUIET = (SILENT,) * 6


@dataclass(frozen=True, slots=True)
class ForceTorqueSensor(LinkSensor):
    """A sensor in a joint, which may be fixed; `link` is the joint's child.

    The torque is about the sensor's origin: the joint's, moved by `<pose>`.

    Attributes:
        parent: the joint's parent link.
        frame: whose axes force and torque are seen in: child, parent, or sensor.
        direction: child_to_parent for what the child does to the parent, as Gazebo's default,
            or parent_to_child.
        channel_noise: of force x, y, z in N and torque x, y, z in N m.
    """

    parent: str = ""
    frame: str = FRAMES[0]
    direction: str = DIRECTIONS[0]
    channel_noise: tuple[NoiseModel, ...] = QUIET

    type: ClassVar[str] = "force_torque"
    channels: ClassVar[tuple[str, ...]] = FORCE_TORQUE_INTERFACES

    @classmethod
    def read(cls, tags: SensorTags, joint: Joint) -> "ForceTorqueSensor":
        """Return the sensor that the tags describe.

        Raises:
            SensorError: a value is nonsense.
        """
        pose = tags.pose()
        frame = tags.choice("frame", FRAMES)
        noise = (
            read_noise(tags, f"{vector}/{axis}") for vector in ("force", "torque") for axis in "xyz"
        )
        return cls(
            name=tags.name,
            link=joint.child,
            frame_id=tags.frame(joint.parent if frame == "parent" else joint.child),
            topic=tags.own_topics()[0],
            rate_hz=tags.rate_hz(),
            xyz=(pose[0], pose[1], pose[2]),
            rpy=(pose[3], pose[4], pose[5]) if frame == "sensor" else (0.0, 0.0, 0.0),
            parent=joint.parent,
            frame=frame,
            direction=tags.choice("measure_direction", DIRECTIONS),
            channel_noise=tuple(noise),
        )

    @property
    def noise(self) -> tuple[NoiseModel, ...]:
        """The noise of each channel."""
        return self.channel_noise

    def measurements(self) -> Sequence[Measurement]:
        """Return force, torque, and how the sensor is turned in the parent."""
        sensor, site = mujoco.mjtSensor, mujoco.mjtObj.mjOBJ_SITE
        wrench = [
            Measurement("force", sensor.mjSENS_FORCE, site, self.key),
            Measurement("torque", sensor.mjSENS_TORQUE, site, self.key),
        ]
        if self.frame != "parent":
            return wrench
        turned = Measurement("turned", sensor.mjSENS_FRAMEQUAT, site, self.key, self.parent)
        return [*wrench, turned]

    def reading(self, measured: NDArray[np.float64]) -> NDArray[np.float64]:
        """Return force and torque; MuJoCo's are those that the parent exerts on the child."""
        wrench = measured[:6].copy()
        if self.frame == "parent":
            turned = measured[6:]
            mujoco.mju_rotVecQuat(wrench[:3], measured[:3], turned)
            mujoco.mju_rotVecQuat(wrench[3:], measured[3:6], turned)
        return wrench if self.direction == "parent_to_child" else 0.0 - wrench
