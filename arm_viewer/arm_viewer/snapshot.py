"""What the page knows of the robots at one moment: plain, frozen data without ROS.

The ROS thread makes a new snapshot in every tick; whoever has one may keep it, in any thread.
SI units: m, rad, s. `received_s` is a time of `time.monotonic`.
"""

from collections.abc import Mapping
from dataclasses import dataclass, field
from enum import Enum
from types import MappingProxyType

import numpy as np
from numpy.typing import NDArray

from arm_description.robot import Robot
from arm_viewer.drawing.node_graph import NodeTopics


@dataclass(frozen=True, slots=True)
class Description:
    """A robot as a topic describes it.

    Attributes:
        topic: such as "/left/robot_description".
        namespace: what stands before robot_description, without a slash at the end: "/left", "".
        robot: None where the description is none.
        problem: why it is none; empty where it is one.
    """

    topic: str
    namespace: str
    robot: Robot | None
    problem: str = ""


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


@dataclass(frozen=True, slots=True, eq=False)
class Picture:
    """An image as it was sent: rows of `step` bytes in `data`, as sensor_msgs/msg/Image says."""

    encoding: str
    width: int
    height: int
    step: int
    is_bigendian: bool
    data: NDArray[np.uint8]


@dataclass(frozen=True, slots=True)
class CameraView:
    """What a camera sees, as sensor_msgs/msg/CameraInfo says.

    A point (x, y, z) of the frame is seen at the pixel u = fx x / z + cx, v = fy y / z + cy.

    Attributes:
        frame: the optical one: z looks forward, x to the picture's right, y to its lower edge.
        width: of the picture, in pixels, as everything that follows.
        height: likewise.
        focal_lengths: fx and fy.
        centre: cx and cy.
    """

    frame: str
    width: int
    height: int
    focal_lengths: tuple[float, float]
    centre: tuple[float, float]


class MarkerShape(Enum):
    """What a marker is, in a cube with sides of 1 that its scale stretches."""

    BOX = "box"
    BALL = "ball"
    CYLINDER = "cylinder"
    MESH = "mesh"
    TRIANGLES = "triangles"


@dataclass(frozen=True, slots=True)
class MarkerLook:
    """What a marker looks like, wherever it is.

    Attributes:
        shape: what it is.
        scale: along its axes; m for a box, a ball and a cylinder.
        rgba: colour, each 0 to 1.
        mesh_uri: of a mesh.
        points: of triangles: three times x, y, z in float32 for each, before the scale.
    """

    shape: MarkerShape
    scale: tuple[float, float, float]
    rgba: tuple[float, float, float, float]
    mesh_uri: str = ""
    points: bytes = b""


@dataclass(frozen=True, slots=True)
class Marker:
    """A shape of the world, and where it is in its frame: m, and a unit quaternion."""

    look: MarkerLook
    frame: str
    position: tuple[float, float, float]
    rotation: tuple[float, float, float, float]


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
class SimulationTime:
    """What /clock says, and how it keeps up with the clock on the wall.

    Attributes:
        time_s: the simulation's time.
        factor: simulated over wall time in the last two seconds; 0 where it stands still.
        lag_s: how much less than the wall's the simulation's time grew in `measured_s`.
        measured_s: the wall's seconds that were looked at: ten, fewer at first.
    """

    time_s: float
    factor: float
    lag_s: float
    measured_s: float


@dataclass(frozen=True, slots=True)
class Topic:
    """A topic of the graph.

    Attributes:
        name: absolute.
        types: usually one.
        publishers: how many there are.
        subscriptions: how many there are, besides the page's own.
        rate_hz: messages in a second; NaN where that is not measured.
    """

    name: str
    types: tuple[str, ...]
    publishers: int
    subscriptions: int
    rate_hz: float


@dataclass(frozen=True, slots=True)
class Snapshot:
    """All of it. A mapping's keys are topics, but for `transforms`: child frames."""

    made_s: float = 0.0
    descriptions: Mapping[str, Description] = field(default_factory=lambda: MappingProxyType({}))
    transforms: Mapping[str, Transform] = field(default_factory=lambda: MappingProxyType({}))
    joint_states: Mapping[str, JointStates] = field(default_factory=lambda: MappingProxyType({}))
    image_topics: tuple[str, ...] = ()
    pictures: Mapping[str, Picture] = field(default_factory=lambda: MappingProxyType({}))
    """The newest of the topics that the page wants to see."""
    cameras: Mapping[str, CameraView] = field(default_factory=lambda: MappingProxyType({}))
    markers: Mapping[str, Marker] = field(default_factory=lambda: MappingProxyType({}))
    """The world's shapes, by a name of their own."""
    displayed: frozenset[str] = frozenset()
    """The namespaces in which the page itself publishes the joint states."""
    controllers: tuple[Controller, ...] = ()
    refusal: str = ""
    """Why the last switch of controllers was refused; empty where it was not."""
    commands: Mapping[str, Mapping[str, float]] = field(
        default_factory=lambda: MappingProxyType({})
    )
    """What active controllers were told last, by namespace and command interface "j0/position"."""
    time: SimulationTime | None = None
    """None where nobody publishes /clock."""
    topics: tuple[Topic, ...] = ()
    nodes: tuple[NodeTopics, ...] = ()
