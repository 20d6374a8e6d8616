"""A sensor at work: it reads the present state of the simulation."""

from typing import TYPE_CHECKING

import mujoco
import numpy as np
from numpy.typing import NDArray

from arm_gazebo.sensors.link_sensor import LinkSensor
from arm_gazebo.sensors.noise import SensorNoise

if TYPE_CHECKING:
    from arm_gazebo.physics.simulation import Simulation


class Instrument:
    """Reads one sensor; loop thread. One state gives one reading, however often it is read.

    Args:
        simulation: whose model has the sensor.
        sensor: what to read.
        seed: of the run's noise.
    """

    def __init__(self, simulation: "Simulation", sensor: LinkSensor, seed: int = 0) -> None:
        self.sensor = sensor
        self._simulation = simulation
        noisy = any(not model.is_silent for model in sensor.noise)
        self._noise = SensorNoise(sensor.noise, sensor.key, seed) if noisy else None
        self._model: mujoco.MjModel | None = None
        self._addresses = np.empty(0, np.intp)

    def read(self) -> NDArray[np.float64]:
        """Return the present values of the sensor's channels."""
        model = self._simulation.model
        if model is not self._model:
            # The world has changed: MuJoCo has its sensors elsewhere.
            self._model, self._addresses = model, self.sensor.addresses(model)
        state = self._simulation.observe()
        reading = self.sensor.reading(state.sensordata[self._addresses])
        if self._noise is not None:
            self._noise.add_to(reading, self._simulation.probe.number)
        return reading
