"""The joints of the simulated robot as arrays."""

from collections.abc import Iterator, Mapping
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from arm_gazebo.physics.physics import Physics
from arm_sim.errors import UnknownNameError
from arm_sim.user_traceback import ends_at_the_caller

Array = NDArray[np.float64]


@dataclass(frozen=True, slots=True)
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
