"""What the simulated robot measures: its joints as arrays, its hardware, its sensors."""

from collections.abc import Iterator, Mapping, Sequence

import numpy as np
from numpy.typing import NDArray

from arm_control.hardware.resource_manager import ResourceManager
from arm_gazebo.hardware.simulated_sensors import SimulatedSensor
from arm_gazebo.physics.physics import Physics
from arm_node.frozen import frozen
from arm_sim.errors import UnknownNameError
from arm_sim.user_traceback import ends_at_the_caller

Array = NDArray[np.float64]


@frozen
class JointState:
    """The state of one joint.

    Attributes:
        position: in rad or m.
        velocity: in rad/s or m/s.
        effort: of its drive, in N m or N.
    """

    position: float
    velocity: float
    effort: float


@ends_at_the_caller
class Joints(Mapping[str, JointState]):
    """The present states of all joints that move: by name, or as arrays in the order of `names`.

    Attributes:
        names: names of the joints, in the order of the description.
    """

    def __init__(self, physics: Physics) -> None:
        self._physics = physics
        self.names = tuple(physics.built.joints)
        self.rebind()

    def rebind(self) -> None:
        """Look up the joints in the simulation's model after it was replaced."""
        joints = [self._physics.built.joints[name] for name in self.names]
        self._positions = np.array([joint.qpos_address for joint in joints], dtype=np.intp)
        self._velocities = np.array([joint.dof_address for joint in joints], dtype=np.intp)

    @property
    def position(self) -> Array:
        """Positions in rad or m, shape (n,); a copy."""
        return self._physics.data.qpos[self._positions]

    @property
    def velocity(self) -> Array:
        """Velocities in rad/s or m/s, shape (n,); a copy."""
        return self._physics.data.qvel[self._velocities]

    @property
    def effort(self) -> Array:
        """Efforts of the drives in N m or N, shape (n,); a copy."""
        return self._physics.data.qfrc_actuator[self._velocities]

    def __getitem__(self, name: str) -> JointState:
        if name not in self.names:
            raise UnknownNameError(f"no joint '{name}'; the robot has {', '.join(self.names)}")
        data, index = self._physics.data, self.names.index(name)
        position, velocity = self._positions[index], self._velocities[index]
        return JointState(
            float(data.qpos[position]),
            float(data.qvel[velocity]),
            float(data.qfrc_actuator[velocity]),
        )

    def __iter__(self) -> Iterator[str]:
        return iter(self.names)

    def __len__(self) -> int:
        return len(self.names)


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
