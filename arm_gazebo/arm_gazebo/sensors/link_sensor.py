"""What the sensors that MuJoCo reads have in common: where they sit, and where readings go."""

from abc import ABC, abstractmethod
from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from typing import ClassVar

import mujoco
import numpy as np
from numpy.typing import NDArray

from arm_gazebo.quaternion import wxyz
from arm_gazebo.sensors.noise import NoiseModel

Vector = tuple[float, float, float]


@dataclass(frozen=True, slots=True)
class Measurement:
    """One of MuJoCo's own sensors.

    Attributes:
        name: within the sensor.
        type: what it measures.
        object_type: of what it is attached to.
        object_name: likewise.
        reference: link whose axes and origin it is seen from; empty for the world.
        options: integers that the type takes.
    """

    name: str
    type: mujoco.mjtSensor
    object_type: mujoco.mjtObj
    object_name: str
    reference: str = ""
    options: tuple[int, int, int] = (0, 0, 0)


@dataclass(frozen=True, slots=True)
class LinkSensor(ABC):
    """A sensor on a link, as the URDF describes it.

    Attributes:
        name: unique in its robot; see `told_apart`.
        link: carries it.
        frame_id: of the messages' headers.
        topic: of the readings; relative ones are in the node's namespace.
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
    """Gazebo's name of what it is."""
    channels: ClassVar[tuple[str, ...]]
    """Names of the numbers of a reading, in their order; ros2_control's where it has some."""

    @property
    def key(self) -> str:
        """Name of the sensor's site; links are unique among all robots of a world."""
        return f"{self.link}/{self.name}"

    @property
    def noise(self) -> tuple[NoiseModel, ...]:
        """The noise of each channel; empty for none."""
        return ()

    @abstractmethod
    def measurements(self) -> Sequence[Measurement]:
        """Return what MuJoCo shall measure."""

    @abstractmethod
    def reading(self, measured: NDArray[np.float64]) -> NDArray[np.float64]:
        """Return the channels of what was measured, all measurements side by side."""

    def add_to(self, spec: mujoco.MjSpec, bodies: Mapping[str, mujoco.MjsBody]) -> None:
        """Add a site to the link, and the measurements."""
        # In a group of its own, so that no picture shows it.
        bodies[self.link].add_site(name=self.key, pos=self.xyz, quat=wxyz(self.rpy), group=5)
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
        """Return where in `sensordata` the measurements are."""
        found = (model.sensor(f"{self.key}/{part.name}") for part in self.measurements())
        return np.concatenate([np.arange(s.adr[0], s.adr[0] + s.dim[0]) for s in found])
