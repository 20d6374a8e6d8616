"""The state of the robots and of the graph at one moment: frozen data without ROS.

The ROS thread creates a new snapshot in every tick. Any thread may keep one.
SI units: m, rad, s. `received_s` is a time of `time.monotonic`.
"""

import math
from collections.abc import Mapping
from dataclasses import dataclass, field
from enum import Enum
from types import MappingProxyType
from typing import TYPE_CHECKING

import numpy as np
from numpy.typing import NDArray

from arm_description.urdf.robot import Robot
from arm_node.drawing import NodeTopics
from arm_node.rigid_transform import RigidTransform
from arm_viewer.calls.call import Callee, CallState
from arm_viewer.plots.history import Curves
from arm_viewer.world.world_view import WorldView

if TYPE_CHECKING:
    # Imported at run time only where a move_group runs.
    from arm_viewer.planning import PlanningView


@dataclass(frozen=True, slots=True)
class Description:
    """A robot description from a topic.

    Attributes:
        topic: such as "/left/robot_description".
        namespace: the topic's namespace without a trailing slash, such as "/left" or "".
        robot: the parsed robot; None if the description is invalid.
        problem: why it is invalid; empty if it is valid.
        initial: initial joint positions in the description, in rad or m.
    """

    topic: str
    namespace: str
    robot: Robot | None
    problem: str = ""
    initial: Mapping[str, float] = field(default_factory=lambda: MappingProxyType({}))


@dataclass(frozen=True, slots=True)
class Transform:
    """The pose of a frame in its parent."""

    parent: str
    pose: RigidTransform


@dataclass(frozen=True, slots=True)
class JointReading:
    """One joint's values in the last message that named it; NaN for missing values."""

    position: float
    velocity: float
    effort: float


@dataclass(frozen=True, slots=True)
class JointStates:
    """The latest joint states of a topic, by joint."""

    joints: Mapping[str, JointReading]
    received_s: float


@dataclass(frozen=True, slots=True, eq=False)
class Picture:
    """An image as received: rows of `step` bytes in `data`, as in sensor_msgs/msg/Image."""

    encoding: str
    width: int
    height: int
    step: int
    is_bigendian: bool
    data: NDArray[np.uint8]


@dataclass(frozen=True, slots=True)
class CameraView:
    """The intrinsics of a camera from sensor_msgs/msg/CameraInfo, in pixels.

    A point (x, y, z) of the frame appears at the pixel u = fx x / z + cx, v = fy y / z + cy.

    Attributes:
        frame: the optical frame: z points forward, x to the image's right, y down.
        width: width of the image.
        height: height of the image.
        focal_lengths: fx and fy.
        centre: cx and cy.
    """

    frame: str
    width: int
    height: int
    focal_lengths: tuple[float, float]
    centre: tuple[float, float]


class MarkerShape(Enum):
    """The shape of a marker, in a unit cube that the marker's scale stretches."""

    BOX = "box"
    BALL = "ball"
    CYLINDER = "cylinder"
    MESH = "mesh"
    TRIANGLES = "triangles"


@dataclass(frozen=True, slots=True)
class MarkerLook:
    """The look of a marker without its pose.

    Attributes:
        shape: shape of the marker.
        scale: scale along its axes; in m for a box, a ball and a cylinder.
        rgba: colour, each component 0 to 1.
        mesh_uri: URI of a mesh.
        points: corners of triangles, three times x, y, z in float32 for each, unscaled.
    """

    shape: MarkerShape
    scale: tuple[float, float, float]
    rgba: tuple[float, float, float, float]
    mesh_uri: str = ""
    points: bytes = b""


@dataclass(frozen=True, slots=True)
class Marker:
    """A shape of the world with its pose in a frame."""

    look: MarkerLook
    frame: str
    pose: RigidTransform


@dataclass(frozen=True, slots=True, eq=False)
class ContactForces:
    """Where things touch, and the forces there.

    Attributes:
        frame: frame of the places.
        points: in m, shape (n, 3).
        lines: from each point along its force, as long as the publisher draws it, shape (n, 2, 3).
        strongest: the strongest contacts in words.
    """

    frame: str
    points: NDArray[np.float32]
    lines: NDArray[np.float32]
    strongest: tuple[str, ...]


@dataclass(frozen=True, slots=True)
class ListedController:
    """A controller as its manager lists it.

    Attributes:
        manager: absolute name of the manager's node.
        name: name of the controller.
        type: such as "position_controllers/JointGroupPositionController".
        state: "active", "inactive", "unconfigured" or "finalized".
        claimed: its claimed command interfaces, such as "j0/position".
        joints: its parameter `joints`, in order; empty if it has none.
    """

    manager: str
    name: str
    type: str
    state: str
    claimed: tuple[str, ...]
    joints: tuple[str, ...]

    @property
    def namespace(self) -> str:
        """The manager's namespace: "/left", or "" for the root namespace."""
        return self.manager.rpartition("/")[0]


@dataclass(frozen=True, slots=True)
class SimulationTime:
    """Simulation time from /clock compared with wall time.

    Attributes:
        time_s: simulation time.
        factor: real-time factor over the last two seconds; 0 while the simulation is paused.
        lag_s: how far simulation time fell behind wall time in the last ten seconds, or since the
            start or a pause, at least 0.
        received_s: when the last message of /clock arrived.
    """

    time_s: float
    factor: float
    lag_s: float
    received_s: float

    def at(self, now_s: float) -> float:
        """Return simulation time at a time of `time.monotonic`, if it has gone on as before."""
        return self.time_s + self.factor * (now_s - self.received_s)


@dataclass(frozen=True, slots=True)
class NamedSnapshot:
    """A saved moment of the simulation, as the simulation lists it."""

    name: str
    description: str


@dataclass(frozen=True, slots=True)
class RunStatus:
    """What the simulation says about its run.

    Attributes:
        state: "playing", "paused", "stopped", "quitting", "no world" or "loading a world".
        speed: the wanted ratio of simulation time to wall time, 0 for as fast as possible; NaN
            while it is unknown.
        snapshots: its snapshots with names.
    """

    state: str
    speed: float
    snapshots: tuple[NamedSnapshot, ...]

    @property
    def is_playing(self) -> bool:
        """Whether simulation time goes on."""
        return self.state == "playing"


@dataclass(frozen=True, slots=True)
class ControlAnswer:
    """What became of the user's last request to the simulation or to the emergency stop.

    Attributes:
        number: counts the answers.
        text: a sentence for the user; empty if what happened shows by itself.
        is_done: whether it was done.
    """

    number: int
    text: str
    is_done: bool


@dataclass(frozen=True, slots=True)
class Topic:
    """A topic of the graph.

    Attributes:
        name: absolute name.
        types: types of the topic, usually one.
        publishers: number of publishers.
        subscriptions: number of subscriptions except the page's own.
        rate_hz: messages per second; NaN if not measured.
        bytes_per_s: bandwidth; NaN if not measured.
        delay_s: mean time from the stamps to the arrival; NaN if not measured, or without stamps.
    """

    name: str
    types: tuple[str, ...]
    publishers: int
    subscriptions: int
    rate_hz: float
    bytes_per_s: float = math.nan
    delay_s: float = math.nan


@dataclass(frozen=True, slots=True)
class LogEntry:
    """A message of a node's logger.

    Attributes:
        number: counts the entries of this page.
        time_s: its stamp, in simulation time if the node uses that.
        level: 10, 20, 30, 40 or 50, as in rcl_interfaces/msg/Log.
        node: name of the logger.
        text: the message.
        place: function, file and line.
    """

    number: int
    time_s: float
    level: int
    node: str
    text: str
    place: str


@dataclass(frozen=True, slots=True)
class ComponentStatus:
    """The last status of a component, as in diagnostic_msgs/msg/DiagnosticStatus.

    Attributes:
        level: 0 is OK, 1 a warning, 2 an error, 3 stale.
        text: what the component says.
        hardware: identity of the hardware.
        values: keys and values.
        received_s: when it arrived.
    """

    level: int
    text: str
    hardware: str
    values: tuple[tuple[str, str], ...]
    received_s: float


@dataclass(frozen=True, slots=True)
class Snapshot:
    """The whole state. Mappings are keyed by topic, except `transforms`, by child frame."""

    made_s: float = 0.0
    replay: str = ""
    """The name of the recording that this is a moment of; empty if it is live. Its `made_s` and
    `received_s` then count the seconds that are shown, and stand while the recording does."""
    descriptions: Mapping[str, Description] = field(default_factory=lambda: MappingProxyType({}))
    transforms: Mapping[str, Transform] = field(default_factory=lambda: MappingProxyType({}))
    joint_states: Mapping[str, JointStates] = field(default_factory=lambda: MappingProxyType({}))
    hardware_positions: Mapping[str, Mapping[str, float]] = field(
        default_factory=lambda: MappingProxyType({})
    )
    """Positions of joints, by namespace, where a controller manager knows them and nobody publishes
    joint states."""
    lost: frozenset[str] = frozenset()
    """The topics of descriptions and joint states that are no longer published."""
    image_topics: tuple[str, ...] = ()
    pictures: Mapping[str, Picture] = field(default_factory=lambda: MappingProxyType({}))
    """The latest images of the topics that the page shows."""
    cameras: Mapping[str, CameraView] = field(default_factory=lambda: MappingProxyType({}))
    markers: Mapping[str, Marker] = field(default_factory=lambda: MappingProxyType({}))
    """The world's shapes, by unique name."""
    contacts: ContactForces | None = None
    """None while nobody publishes them, or the page does not show them."""
    displayed: frozenset[str] = frozenset()
    """The namespaces in which the page itself publishes the joint states."""
    controllers: tuple[ListedController, ...] = ()
    refusal: str = ""
    """Why the last switch of controllers was refused; empty if it succeeded."""
    commands: Mapping[str, Mapping[str, float]] = field(
        default_factory=lambda: MappingProxyType({})
    )
    """The last commands to active controllers, by namespace and interface such as "j0/position"."""
    time: SimulationTime | None = None
    """None if /clock has no publisher."""
    run: RunStatus | None = None
    """None if no simulation answers."""
    world: WorldView | None = None
    """None if no simulation serves its world."""
    stops: Mapping[str, bool] = field(default_factory=lambda: MappingProxyType({}))
    """Whether the emergency stop is engaged, by the namespace that offers one."""
    control_answer: ControlAnswer = ControlAnswer(0, "", True)
    topics: tuple[Topic, ...] = ()
    log: tuple[LogEntry, ...] = ()
    """The newest messages of /rosout, oldest first."""
    diagnoses: Mapping[str, ComponentStatus] = field(default_factory=lambda: MappingProxyType({}))
    """The last status of each component, by name."""
    numbers: Mapping[str, tuple[str, ...]] = field(default_factory=lambda: MappingProxyType({}))
    """The paths of the numbers in the messages of each topic, once somebody has asked for them."""
    curves: Curves = field(default_factory=Curves)
    """The curves that are plotted; they grow. Another object has the curves of another run."""
    curves_s: float = math.nan
    """Where the curves of a recording end now, in s since the epoch; NaN while they are live."""
    callees: tuple[Callee, ...] = ()
    """What can be called."""
    calls: Mapping[int, CallState] = field(default_factory=lambda: MappingProxyType({}))
    """What has become of each call, by its number."""
    nodes: tuple[NodeTopics, ...] = ()
    planning: "Mapping[str, PlanningView]" = field(default_factory=lambda: MappingProxyType({}))
    """The move_groups, by namespace."""

    def readings(self, namespace: str) -> Mapping[str, JointReading]:
        """Return the joints of a namespace, none as long as nobody publishes their states."""
        states = self.joint_states.get(f"{namespace}/joint_states")
        return {} if states is None else states.joints

    def positions(self, namespace: str) -> dict[str, float]:
        """Return the finite positions of a namespace's joints."""
        readings = self.readings(namespace).items()
        return {name: r.position for name, r in readings if math.isfinite(r.position)}


def frame_name(frame_id: str) -> str:
    """Return the name of a frame without a leading slash, which tf2 also ignores."""
    return frame_id.removeprefix("/")
