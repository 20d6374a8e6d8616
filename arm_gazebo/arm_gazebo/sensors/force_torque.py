"""A force-torque sensor: the wrench that a joint transmits between its two links."""

from collections.abc import Sequence
from typing import ClassVar

import mujoco
import numpy as np
from numpy.typing import NDArray

from arm_control.controllers.sensor_broadcasters.readings import FORCE_TORQUE_INTERFACES
from arm_description.urdf.robot import Robot
from arm_gazebo.sensors.link_sensor import WRENCH_FIELDS, LinkSensor, Measurement, SensorTopic
from arm_gazebo.sensors.noise import SILENT, NoiseModel, read_noise
from arm_gazebo.sensors.tags import SensorTags
from arm_node.frozen import frozen

FRAMES = ("child", "parent", "sensor")
DIRECTIONS = ("child_to_parent", "parent_to_child")
QUIET = (SILENT,) * 6


@frozen
class ForceTorqueSensor(LinkSensor):
    """A sensor in a joint, which may be fixed; `link` is the joint's child link.

    The torque is about the sensor's origin: the joint's origin, moved by `<pose>`.

    Attributes:
        parent: the joint's parent link.
        frame: the axes of force and torque: child, parent, or sensor.
        direction: child_to_parent (Gazebo's default) for the wrench that the child exerts on the
            parent, or parent_to_child.
        channel_noise: noise of force x, y, z in N and torque x, y, z in N m.
    """

    parent: str = ""
    frame: str = FRAMES[0]
    direction: str = DIRECTIONS[0]
    channel_noise: tuple[NoiseModel, ...] = QUIET

    type: ClassVar[str] = "force_torque"
    channels: ClassVar[tuple[str, ...]] = FORCE_TORQUE_INTERFACES
    reference: ClassVar[str] = "joint"

    @classmethod
    def read(cls, tags: SensorTags, robot: Robot) -> "ForceTorqueSensor":
        """Return the sensor that the tags describe.

        Raises:
            SensorError: a value is invalid.
        """
        joint = robot.joint(tags.reference)
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

    def topics(self) -> Sequence[SensorTopic]:
        """Return the topic of the wrench."""
        return (SensorTopic("geometry_msgs/msg/WrenchStamped", WRENCH_FIELDS),)

    def measurements(self) -> Sequence[Measurement]:
        """Return the measurements of force, torque, and the sensor's orientation in the parent."""
        sensor, site = mujoco.mjtSensor, mujoco.mjtObj.mjOBJ_SITE
        wrench = [
            Measurement("force", sensor.mjSENS_FORCE, site, self.key),
            Measurement("torque", sensor.mjSENS_TORQUE, site, self.key),
        ]
        if self.frame != "parent":
            return wrench
        kind = sensor.mjSENS_FRAMEQUAT
        return [*wrench, Measurement("orientation", kind, site, self.key, self.parent)]

    def reading(self, measured: NDArray[np.float64], state: mujoco.MjData) -> NDArray[np.float64]:
        """Return force and torque. MuJoCo measures what the parent exerts on the child."""
        wrench = measured[:6].copy()
        if self.frame == "parent":
            orientation = measured[6:]
            mujoco.mju_rotVecQuat(wrench[:3], measured[:3], orientation)
            mujoco.mju_rotVecQuat(wrench[3:], measured[3:6], orientation)
        return wrench if self.direction == "parent_to_child" else 0.0 - wrench
