"""Shows a replayed run to everything of ROS: on its topics, at a pace, or as a bag.

The messages are clock, joint states, transforms, shapes, contacts and descriptions.
"""

import time
from collections.abc import Mapping
from pathlib import Path
from typing import TYPE_CHECKING, Any

import numpy as np
from builtin_interfaces.msg import Time
from geometry_msgs.msg import Point, Pose, Quaternion, Transform, TransformStamped, Vector3
from rosgraph_msgs.msg import Clock
from sensor_msgs.msg import JointState
from std_msgs.msg import Header, String
from tf2_msgs.msg import TFMessage
from visualization_msgs.msg import MarkerArray

from arm_cli.bag_format.offered_qos import OfferedQos
from arm_cli.bag_format.topic import BagMessage, BagTopic, find_definition
from arm_cli.bag_format.writer import BagSettings, BagWriter
from arm_cli.interface_types import InterfaceIndex
from arm_gazebo.recording.replay import Replay
from arm_gazebo.ros.contact_markers import TOPIC as CONTACT_TOPIC
from arm_gazebo.ros.contact_markers import contact_markers
from arm_gazebo.ros.world_markers import MOVED, TOPIC, marker_of
from arm_gazebo.run.robot import SimulatedRobot
from arm_gazebo.world.changes import WorldChanges
from arm_gazebo.world.contacts import contacts_of
from arm_gazebo.world.entity import WORLD_FRAME, Entities
from arm_gazebo.world.shapes import WorldShapes
from arm_node.qos import LATCHED
from arm_node.workarounds.message_template import serialized

if TYPE_CHECKING:
    from arm_cli.ros.session import CommandSession

CLOCK, TF, MARKERS, CONTACTS = "/clock", "/tf", f"/{TOPIC}", f"/{CONTACT_TOPIC}"


class _ReplayedMessages:
    """Makes messages of a replay's present state, each by its topic; the replay's thread.

    Each link is a child of the frame `world`, where the replay has it; nothing is computed from the
    joint states.
    """

    def __init__(self, replay: Replay) -> None:
        self._replay = replay
        self._model: object = None
        self._contacts: MarkerArray | None = None
        self._joints = {
            f"{_namespace(robot)}/joint_states": [
                name.removesuffix("/position")
                for name in robot.manager.resources.state_names
                if name.endswith("/position")
            ]
            for robot in replay.robots
        }

    def descriptions(self) -> Mapping[str, String]:
        """Return the descriptions of the robots, which never change."""
        return {
            f"{_namespace(robot)}/robot_description": String(data=robot.document.text)
            for robot in self._replay.robots
        }

    def clock(self) -> Clock:
        """Return the simulation time."""
        return Clock(clock=self._stamp())

    def joint_states(self) -> Mapping[str, JointState]:
        """Return the joint states of each robot."""
        joints, data = self._replay.simulation.built.joints, self._replay.simulation.data
        states: dict[str, JointState] = {}
        for topic, names in self._joints.items():
            known = [joints[name] for name in names if name in joints]
            dofs = np.array([joint.dof_address for joint in known], dtype=np.intp)
            states[topic] = JointState(
                header=Header(stamp=self._stamp()),
                name=[joint.name for joint in known],
                position=[float(data.qpos[joint.qpos_address]) for joint in known],
                velocity=data.qvel[dofs].tolist(),
                effort=data.qfrc_actuator[dofs].tolist(),
            )
        return states

    def transforms(self) -> TFMessage:
        """Return the pose of each link."""
        # The poses in MuJoCo's own data belong to the state before the last step.
        data, stamp = self._replay.simulation.observe(), self._stamp()
        transforms: list[TransformStamped] = []
        for link, body in self._replay.simulation.built.bodies.items():
            if link == WORLD_FRAME:
                continue
            x, y, z = data.xpos[body].tolist()
            qw, qx, qy, qz = data.xquat[body].tolist()
            pose = Transform(
                translation=Vector3(x=x, y=y, z=z), rotation=Quaternion(x=qx, y=qy, z=qz, w=qw)
            )
            header = Header(stamp=stamp, frame_id=WORLD_FRAME)
            transforms.append(TransformStamped(header=header, child_frame_id=link, transform=pose))
        return TFMessage(transforms=transforms)

    def markers(self) -> MarkerArray | None:
        """Return the shapes around the robots if one has moved since the last call, or is new.

        It is the same message, whose poses change.
        """
        self._follow_model()
        data = self._replay.simulation.observe()
        poses = self._shapes.poses(data.geom_xpos, data.geom_xmat)
        if np.abs(poses - self._poses).max(initial=0.0) < MOVED:
            return None
        self._poses = poses
        each = zip(self._markers.markers, poses.tolist(), strict=True)
        for marker, (x, y, z, qx, qy, qz, qw) in each:
            turn = Quaternion(x=qx, y=qy, z=qz, w=qw)
            marker.pose = Pose(position=Point(x=x, y=y, z=z), orientation=turn)
        return self._markers

    def contacts(self) -> MarkerArray | None:
        """Return the contacts and their forces if they have changed since the last call."""
        self._follow_model()
        simulation = self._replay.simulation
        each = contacts_of(None, simulation.model, simulation.observe(), self._entities)
        found = contact_markers(each)
        if found == self._contacts:
            return None
        self._contacts = found
        return found

    def _follow_model(self) -> None:
        """Take notice of another model, which may have other shapes and entities."""
        built = self._replay.simulation.built
        if built.model is self._model:
            return
        self._model = built.model
        self._entities = Entities(built, WorldChanges(), {})
        self._shapes = WorldShapes(built.model, self._entities)
        shown = [marker_of(shape) for shape in self._shapes.shapes]
        self._markers = MarkerArray(markers=shown)
        self._poses = np.full((len(shown), 7), np.nan)

    def _stamp(self) -> Time:
        nanoseconds = round(self._replay.simulation.time_s * 1e9)
        return Time(sec=nanoseconds // 10**9, nanosec=nanoseconds % 10**9)


def _namespace(robot: SimulatedRobot) -> str:
    return robot.manager.name.rpartition("/")[0]


PUBLISH_PERIOD_S = 0.02
MARKER_EVERY = 5
"""Shapes and contacts are looked at with every fifth state."""
HOLD_PERIOD_S = 0.1


class RunPlayer:
    """Shows a replay to ROS tools, from before its first period. Use it in the session's thread.

    The speed is in simulated seconds for each second of wall time.
    """

    def __init__(self, session: "CommandSession", replay: Replay, speed: float) -> None:
        node = session.node
        self._session = session
        self._replay = replay
        self._speed = speed
        self._messages = _ReplayedMessages(replay)
        self._clock = node.create_publisher(Clock, CLOCK, 10)
        self._transforms = node.create_publisher(TFMessage, TF, 100)
        self._markers = node.create_publisher(MarkerArray, MARKERS, LATCHED)
        self._contacts = node.create_publisher(MarkerArray, CONTACTS, LATCHED)
        for topic, text in self._messages.descriptions().items():
            node.create_publisher(String, topic, LATCHED).publish(text)
        self._states = {
            topic: node.create_publisher(JointState, topic, 10)
            for topic in self._messages.joint_states()
        }
        self._started_s = time.monotonic()
        self._first_s = replay.simulation.time_s
        self._next_s = 0.0
        self._published = 0

    def show(self) -> None:
        """Publish the present state if one is due; call it after each period.

        Raises:
            StoppedError: a signal arrived.
        """
        shown_s = (self._replay.simulation.time_s - self._first_s) / self._speed
        if shown_s < self._next_s:
            return
        self._next_s = shown_s + PUBLISH_PERIOD_S
        self._publish()
        wait_s = self._started_s + shown_s - time.monotonic()
        if wait_s > 0.0:
            self._session.spin_for(wait_s)
        else:
            self._session.spin_once(0.0)

    def hold(self) -> None:
        """Publish the last state again and again, until Ctrl-C.

        Raises:
            StoppedError: a signal arrived.
        """
        while True:
            self._publish()
            self._session.spin_for(HOLD_PERIOD_S)

    def _publish(self) -> None:
        self._clock.publish(self._messages.clock())
        for topic, state in self._messages.joint_states().items():
            self._states[topic].publish(state)
        self._transforms.publish(self._messages.transforms())
        self._published += 1
        if self._published % MARKER_EVERY == 1:
            shapes, contacts = self._messages.markers(), self._messages.contacts()
            if shapes is not None:
                self._markers.publish(shapes)
            if contacts is not None:
                self._contacts.publish(contacts)


SHOWN_PERIOD_S = 1.0 / 30.0
"""Between two transforms of a link, and two values of the clock."""
MARKER_PERIOD_S = 0.1
_TYPES = {
    Clock: "rosgraph_msgs/msg/Clock",
    JointState: "sensor_msgs/msg/JointState",
    String: "std_msgs/msg/String",
    TFMessage: "tf2_msgs/msg/TFMessage",
    MarkerArray: "visualization_msgs/msg/MarkerArray",
}
_LATCHED = (OfferedQos(durability="transient_local"),)


class RunBag:
    """Writes a bag whose time is that of the recording: 0 at its beginning, and never back.

    Joint states are written after each control period, so that no peak is lost; the rest as often
    as it is shown, and shapes and contacts only when they have changed. The folder must not exist,
    and the replay stands before its first period.

    Raises:
        BagError: the bag cannot be made.
    """

    def __init__(self, folder: Path, replay: Replay) -> None:
        self._replay = replay
        self._messages = _ReplayedMessages(replay)
        self._index = InterfaceIndex()
        self._topics: set[str] = set()
        self._shown_s = self._marked_s = -np.inf
        self._writer = BagWriter(folder, BagSettings(compression="zstd"))
        self._write(self._messages.descriptions())
        self.show()

    def show(self) -> None:
        """Write the present state; call it after each period.

        Raises:
            BagError: the bag cannot be written.
        """
        time_s = self._time_s()
        self._write(self._messages.joint_states())
        if time_s >= self._shown_s + SHOWN_PERIOD_S:
            self._shown_s = time_s
            self._write({CLOCK: self._messages.clock(), TF: self._messages.transforms()})
        if time_s >= self._marked_s + MARKER_PERIOD_S:
            self._marked_s = time_s
            found = {MARKERS: self._messages.markers(), CONTACTS: self._messages.contacts()}
            self._write({topic: m for topic, m in found.items() if m is not None})

    def split(self) -> str:
        """Finish the file of what was shown so far, and begin another; return its name.

        Raises:
            BagError: the bag cannot be written.
        """
        return self._writer.split()

    def close(self) -> None:
        """Finish the bag.

        Raises:
            BagError: the bag cannot be written.
        """
        self._writer.close()

    def _time_s(self) -> float:
        # Simulation time may go back to zero.
        return self._replay.periods * self._replay.simulation.timing.period_s

    def _write(self, messages: Mapping[str, Any]) -> None:
        time_ns = round(self._time_s() * 1e9)
        for topic, message in messages.items():
            if topic not in self._topics:
                self._topics.add(topic)
                kind = _TYPES[type(message)]
                offers = _LATCHED if isinstance(message, String | MarkerArray) else (OfferedQos(),)
                definition = find_definition(self._index, kind)
                self._writer.add_topic(BagTopic(topic, kind, offers=offers), definition)
            self._writer.write(BagMessage(topic, time_ns, time_ns, serialized(message)))
