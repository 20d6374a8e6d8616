"""What the page knows of the robots at one moment: plain, frozen data without ROS.

The ROS thread makes a new snapshot in every tick; whoever has one may keep it, in any thread.
SI units: m, rad, s. `received_s` is a time of `time.monotonic`.
"""

from collections.abc import Mapping
from dataclasses import dataclass, field
from types import MappingProxyType

import numpy as np
from numpy.typing import NDArray


@dataclass(frozen=True, slots=True)
class Description:
    """A robot's URDF, and the topic that it came by.

    Attributes:
        topic: such as "/left/robot_description".
        namespace: what stands before robot_description, without a slash at the end: "/left", "".
        urdf: the text.
    """

    topic: str
    namespace: str
    urdf: str


@dataclass(frozen=True, slots=True)
class Transform:
    """Where a frame is in its parent: m, and the unit quaternion (x, y, z, w)."""

    parent: str
    position: tuple[float, float, float]
    rotation: tuple[float, float, float, float]


@dataclass(frozen=True, slots=True)
class JointReading:
    """One joint in the last message that named it; NaN for what the message did not say."""

    position: float
    velocity: float
    effort: float


@dataclass(frozen=True, slots=True)
class JointStates:
    """The newest joint states of a topic, by joint."""

    joints: Mapping[str, JointReading]
    received_s: float


@dataclass(frozen=True, slots=True)
class Picture:
    """The newest image of a topic, as it was sent."""

    encoding: str
    width: int
    height: int
    step: int
    is_bigendian: bool
    data: NDArray[np.uint8]
    received_s: float


@dataclass(frozen=True, slots=True)
class Controller:
    """A controller as its manager lists it.

    Attributes:
        manager: absolute name of the manager's node.
        name: of the controller.
        type: such as "position_controllers/JointGroupPositionController".
        state: "active", "inactive", "unconfigured" or "finalized".
        claimed: the command interfaces that it holds: "j0/position".
        joints: its parameter `joints`, in its order; empty where it has none.
    """

    manager: str
    name: str
    type: str
    state: str
    claimed: tuple[str, ...]
    joints: tuple[str, ...]

    @property
    def namespace(self) -> str:
        """The manager's namespace: "/left", or "" for the root's."""
        return self.manager.rpartition("/")[0]


@dataclass(frozen=True, slots=True)
class Snapshot:
    """All of it. A mapping's keys are topics, but for `transforms`: child frames."""

    made_s: float = 0.0
    descriptions: Mapping[str, Description] = field(default_factory=lambda: MappingProxyType({}))
    transforms: Mapping[str, Transform] = field(default_factory=lambda: MappingProxyType({}))
    joint_states: Mapping[str, JointStates] = field(default_factory=lambda: MappingProxyType({}))
    controllers: tuple[Controller, ...] = ()
