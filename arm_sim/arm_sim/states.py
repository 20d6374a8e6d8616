"""What the hardware and the sensors of the robot measure."""

from collections.abc import Iterator, Mapping, Sequence

from arm_control.hardware.resource_manager import ResourceManager
from arm_gazebo.hardware.simulated_sensors import SimulatedSensor
from arm_sim.errors import UnknownNameError
from arm_sim.user_traceback import ends_at_the_caller


@ends_at_the_caller
class States(Mapping[str, float]):
    """The state interfaces of the hardware by full name, such as 'j0/position'.

    They are what controllers read, as of the last tick.
    """

    def __init__(self, resources: ResourceManager) -> None:
        self._values = resources.states
        self._indices = {name: index for index, name in enumerate(resources.state_names)}

    def __getitem__(self, name: str) -> float:
        if name not in self._indices:
            raise UnknownNameError(
                f"no state interface '{name}'; the hardware has {', '.join(self._indices)}"
            )
        return float(self._values[self._indices[name]])

    def __iter__(self) -> Iterator[str]:
        return iter(self._indices)

    def __len__(self) -> int:
        return len(self._indices)


@ends_at_the_caller
class Sensors(Mapping[str, Mapping[str, float]]):
    """The present readings of the robot's sensors by name: the values of their channels."""

    def __init__(self, sensors: Sequence[SimulatedSensor]) -> None:
        self._sensors = {sensor.description.name: sensor for sensor in sensors}

    def __getitem__(self, name: str) -> Mapping[str, float]:
        if name not in self._sensors:
            existing = ", ".join(self._sensors) or "none"
            raise UnknownNameError(f"no sensor '{name}'; the robot has {existing}")
        sensor = self._sensors[name]
        return dict(zip(sensor.description.channels, sensor.read().tolist(), strict=True))

    def __iter__(self) -> Iterator[str]:
        return iter(self._sensors)

    def __len__(self) -> int:
        return len(self._sensors)
