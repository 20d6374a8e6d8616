"""The base class of the sensors that MuJoCo computes: their place, their topic, their rate."""

from abc import ABC, abstractmethod
from collections.abc import Mapping, Sequence
from dataclasses import field
from typing import ClassVar

import mujoco
import numpy as np
from numpy.typing import NDArray

from arm_description.transforms import wxyz_from_rpy
from arm_description.urdf.robot import Robot
from arm_gazebo.sensors.noise import NoiseModel
from arm_gazebo.sensors.tags import SensorTags
from arm_node.frozen import frozen

Vector = tuple[float, float, float]

WRENCH_FIELDS = ("wrench.force", "wrench.torque")
"""Fields of geometry_msgs/msg/WrenchStamped that hold the values of a wrench."""


@frozen
class Measurement:
    """One of MuJoCo's own sensors.

    Attributes:
        name: unique within the sensor.
        type: the measured quantity.
        object_type: type of the object that it is attached to.
        object_name: name of that object.
        reference: link in whose frame it is measured; empty for the world.
        options: integer parameters of the type.
    """

    name: str
    type: mujoco.mjtSensor
    object_type: mujoco.mjtObj
    object_name: str
    reference: str = ""
    options: tuple[int, int, int] = (0, 0, 0)


@frozen
class SensorTopic:
    """One topic that a sensor's readings are published on.

    Attributes:
        message: type of the messages, such as "sensor_msgs/msg/Imu".
        fields: the fields that receive the values of a reading, in order; a field may hold
            several values. One with a dot is a field of a field.
        first: index of the first value of the reading that goes into these fields.
        suffix: appended to the sensor's topic, such as "/in_contact".
        constants: fields with the same values in every message.
    """

    message: str
    fields: tuple[str, ...]
    first: int = 0
    suffix: str = ""
    constants: Mapping[str, Sequence[float]] = field(default_factory=dict)


@frozen
class LinkSensor(ABC):
    """A sensor on a link, as the URDF describes it.

    Attributes:
        name: unique in its robot; see `unique_names`.
        link: link that carries the sensor.
        frame_id: frame in the messages' headers.
        topic: topic of the readings; a relative one is in the node's namespace.
        rate_hz: readings per second of simulation time; 0 for one in each control period.
        xyz: position in the link, in m.
        rpy: orientation in the link, in rad.
    """

    name: str
    link: str
    frame_id: str
    topic: str
    rate_hz: float = 0.0
    xyz: Vector = (0.0, 0.0, 0.0)
    rpy: Vector = (0.0, 0.0, 0.0)

    type: ClassVar[str]
    """Gazebo's name of the sensor type."""
    channels: ClassVar[tuple[str, ...]]
    """Names of the values of a reading, in order; ros2_control's names if it has any."""
    reference: ClassVar[str] = "link"
    """Whether its `<gazebo reference="...">` names a "link" or a "joint"."""

    @classmethod
    @abstractmethod
    def read(cls, tags: SensorTags, robot: Robot) -> "LinkSensor":
        """Return the sensor that the tags describe; the reference exists in the robot.

        Raises:
            SensorError: a value is invalid.
        """

    @property
    def key(self) -> str:
        """Name of the sensor's site. Link names are unique among all robots of a world."""
        return f"{self.link}/{self.name}"

    @property
    def noise(self) -> tuple[NoiseModel, ...]:
        """The noise of each channel; empty for none."""
        return ()

    @abstractmethod
    def topics(self) -> Sequence[SensorTopic]:
        """Return the topics that its readings are published on."""

    @abstractmethod
    def measurements(self) -> Sequence[Measurement]:
        """Return the MuJoCo sensors that it needs."""

    @abstractmethod
    def reading(self, measured: NDArray[np.float64], state: mujoco.MjData) -> NDArray[np.float64]:
        """Return the channels, from the concatenated measurements in this state."""

    def add_to(self, spec: mujoco.MjSpec, bodies: Mapping[str, mujoco.MjsBody]) -> None:
        """Add a site to the link, and the measurements."""
        # Its own group keeps the site out of every image.
        bodies[self.link].add_site(
            name=self.key, pos=self.xyz, quat=wxyz_from_rpy(self.rpy), group=5
        )
        for part in self.measurements():
            at_link = part.object_type == mujoco.mjtObj.mjOBJ_BODY
            sensor = spec.add_sensor(
                name=f"{self.key}/{part.name}",
                type=part.type,
                objtype=part.object_type,
                objname=bodies[part.object_name].name if at_link else part.object_name,
                intprm=part.options,
            )
            if part.reference:
                sensor.reftype = mujoco.mjtObj.mjOBJ_XBODY
                sensor.refname = bodies[part.reference].name

    def addresses(self, model: mujoco.MjModel) -> NDArray[np.intp]:
        """Return the indices of the measurements in `sensordata`."""
        found = (model.sensor(f"{self.key}/{part.name}") for part in self.measurements())
        return np.concatenate([np.arange(s.adr[0], s.adr[0] + s.dim[0]) for s in found])
