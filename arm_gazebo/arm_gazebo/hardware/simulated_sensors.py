"""The running sensors: read from the simulation, offered as state interfaces, and published."""

from collections.abc import Sequence
from typing import TYPE_CHECKING

import mujoco
import numpy as np
from numpy.typing import NDArray

from arm_control.controllers.sensor_broadcasters.readings import ReadingSink
from arm_control.hardware.info import HardwareInfo
from arm_gazebo.feed.schedule import FrameSchedule, StreamCount
from arm_gazebo.sensors.link_sensor import LinkSensor
from arm_gazebo.sensors.noise import SensorNoise
from arm_node.index_slice import as_slice

if TYPE_CHECKING:
    from arm_gazebo.physics.physics import Physics


class SimulatedSensor:
    """Reads one sensor; loop thread. Repeated reads of one state give the same reading.

    Attributes:
        channels: names of its values, with the sensor's in front: imu/angular_velocity.x.
    """

    def __init__(self, simulation: "Physics", description: LinkSensor, seed: int = 0) -> None:
        self.description = description
        self._simulation = simulation
        self.channels = tuple(f"{description.name}/{name}" for name in description.channels)
        self.reseed(seed)
        self._model: mujoco.MjModel | None = None
        self._addresses = np.empty(0, np.intp)

    def reseed(self, seed: int) -> None:
        """Use the noise of another run from now on; between two ticks."""
        models = self.description.noise
        noisy = any(not model.is_silent for model in models)
        self._noise = SensorNoise(models, self.description.key, seed) if noisy else None

    def read(self) -> NDArray[np.float64]:
        """Return the present values of the sensor's channels."""
        model = self._simulation.model
        if model is not self._model:
            # The world has changed, and so have the indices of its sensors.
            self._model, self._addresses = model, self.description.addresses(model)
        state = self._simulation.observe()
        reading = self.description.reading(state.sensordata[self._addresses], state)
        if self._noise is not None:
            self._noise.add_to(reading, self._simulation.probe.number)
        self._simulation.faults.apply(self.channels, reading, self._simulation.probe.number)
        return reading


class SensorStates:
    """The state interfaces of the `<sensor>`s of a `<ros2_control>` block; loop thread.

    A sensor of the block is the robot's sensor of the same name, as in gz_ros2_control.

    Attributes:
        names: names of the available state interfaces, in the order of the block.
    """

    def __init__(self, info: HardwareInfo, sensors: Sequence[SimulatedSensor]) -> None:
        by_name = {sensor.description.name: sensor for sensor in sensors}
        names: list[str] = []
        self._parts: list[tuple[SimulatedSensor, slice | NDArray[np.intp], NDArray[np.intp]]] = []
        for part in info.sensors:
            sensor = by_name.get(part.name)
            if sensor is None:
                continue
            channels = sensor.description.channels
            shown = [state.name for state in part.state_interfaces if state.name in channels]
            where = as_slice(np.arange(len(names), len(names) + len(shown)))
            which = np.array([channels.index(name) for name in shown], dtype=np.intp)
            names += [f"{part.name}/{name}" for name in shown]
            if shown:
                self._parts.append((sensor, where, which))
        self.names = tuple(names)

    def fill(self, states: NDArray[np.float64]) -> None:
        """Write the present readings, in the order of `names`, shape (n,)."""
        for sensor, where, which in self._parts:
            states[where] = sensor.read()[which]


class SensorFeed:
    """Publishes sensor readings. A sensor without subscribers is not read.

    Args:
        sensors: the sensors.
        sinks: one for each sensor; receives its readings.
        period_s: control period; a sensor without a rate is read once in each period.

    Attributes:
        schedule: when the next readings are due; it is part of the state of a run.
    """

    def __init__(
        self, sensors: Sequence[SimulatedSensor], sinks: Sequence[ReadingSink], period_s: float
    ) -> None:
        self._channels = tuple(zip(sensors, sinks, strict=True))
        self._rates_hz = [s.description.rate_hz or 1 / period_s for s in sensors]
        self.schedule = FrameSchedule(self._rates_hz)
        self._published = [0] * len(sensors)

    def publish_due(self, time_s: float, data: mujoco.MjData) -> None:
        """Publish the readings that are due at this tick; loop thread."""
        if self.schedule.nothing_due(time_s):
            return
        for due in self.schedule.take_due(time_s):
            sensor, sink = self._channels[due.camera]
            if sink.wanted():
                sink.publish(time_s, sensor.read())
                self._published[due.camera] += 1

    def counts(self) -> tuple[StreamCount, ...]:
        """Return the sensors' figures; loop thread. A reading is never dropped."""
        return tuple(
            StreamCount(sensor.description.topic, "sensor", rate_hz, due, published, 0)
            for (sensor, _), rate_hz, due, published in zip(
                self._channels,
                self._rates_hz,
                self.schedule.serials,
                self._published,
                strict=True,
            )
        )
