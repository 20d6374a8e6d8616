"""A contact sensor: whether anything touches a link, and how hard."""

from collections.abc import Sequence
from typing import ClassVar

import mujoco
import numpy as np
from numpy.typing import NDArray

from arm_control.controllers.sensor_broadcasters.readings import FORCE_TORQUE_INTERFACES
from arm_description.urdf.robot import Robot
from arm_gazebo.sensors.link_sensor import WRENCH_FIELDS, LinkSensor, Measurement, SensorTopic
from arm_gazebo.sensors.tags import SensorTags
from arm_node.frozen import frozen

DATA = mujoco.mjtConDataField
WANTED = (DATA.mjCONDATA_FORCE, DATA.mjCONDATA_TORQUE, DATA.mjCONDATA_POS)
NET_FORCE = 3
"""MuJoCo's reduction of all contacts to one: the summed force at the contacts' centre."""


@frozen
class ContactSensor(LinkSensor):
    """A contact sensor that covers all collision shapes of a link.

    A reading is the number of contact points that carry force, and the force and torque that
    other bodies exert on the link, about its origin and in its axes.
    """

    type: ClassVar[str] = "contact"
    channels: ClassVar[tuple[str, ...]] = ("contacts", *FORCE_TORQUE_INTERFACES)

    @classmethod
    def read(cls, tags: SensorTags, robot: Robot) -> "ContactSensor":
        """Return the sensor that the tags describe.

        Raises:
            SensorError: a value is invalid.
        """
        if len(robot.link(tags.reference).collisions) == 1:
            # Gazebo has a sensor name its collision shape; here all of a link's count.
            tags.ignore("collision")
        return cls(
            name=tags.name,
            link=tags.reference,
            frame_id=tags.frame(tags.reference),
            # Gazebo writes the topic below <contact>; both places are accepted.
            topic=tags.own_topics()[0],
            rate_hz=tags.rate_hz(),
        )

    def topics(self) -> Sequence[SensorTopic]:
        """Return the topic of the force, and the one that tells whether there is contact."""
        return (
            SensorTopic("geometry_msgs/msg/WrenchStamped", WRENCH_FIELDS, first=1),
            SensorTopic("std_msgs/msg/Bool", ("data",), suffix="/in_contact"),
        )

    def measurements(self) -> Sequence[Measurement]:
        """Return the measurements of the net contact and of the link's pose."""
        sensor, body = mujoco.mjtSensor, mujoco.mjtObj.mjOBJ_BODY
        options = (sum(1 << int(field) for field in WANTED), NET_FORCE, 1)
        site = mujoco.mjtObj.mjOBJ_SITE
        return [
            Measurement("net", sensor.mjSENS_CONTACT, body, self.link, options=options),
            Measurement("position", sensor.mjSENS_FRAMEPOS, site, self.key),
            Measurement("orientation", sensor.mjSENS_FRAMEQUAT, site, self.key),
        ]

    def reading(self, measured: NDArray[np.float64], state: mujoco.MjData) -> NDArray[np.float64]:
        """Return the channels. MuJoCo's force is the one that the link exerts on other bodies."""
        reading = np.zeros(len(self.channels))
        reading[0] = self._touching(state)
        if reading[0]:
            force, torque, where = 0.0 - measured[:3], 0.0 - measured[3:6], measured[6:9]
            origin, inverse = measured[9:12], measured[12:16] * (1.0, -1.0, -1.0, -1.0)
            mujoco.mju_rotVecQuat(reading[1:4], force, inverse)
            torque = torque + np.cross(where - origin, force)
            mujoco.mju_rotVecQuat(reading[4:7], torque, inverse)
        return reading

    def _touching(self, state: mujoco.MjData) -> int:
        """Return the number of contacts that press on the link.

        MuJoCo's own count has those in a gap, too, where shapes are only near each other.
        """
        contacts, model = state.contact, state.model
        bodies = model.geom_bodyid[contacts.geom[contacts.efc_address >= 0]]
        return int((bodies == model.site(self.key).bodyid).any(axis=1).sum())
