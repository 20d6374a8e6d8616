"""What a replayed run says to ROS: clock, joint states, transforms, shapes, contacts and more."""

from collections.abc import Mapping

import numpy as np
from builtin_interfaces.msg import Time
from geometry_msgs.msg import Point, Pose, Quaternion, Transform, TransformStamped, Vector3
from rosgraph_msgs.msg import Clock
from sensor_msgs.msg import JointState
from std_msgs.msg import Header, String
from tf2_msgs.msg import TFMessage
from visualization_msgs.msg import MarkerArray

from arm_gazebo.recording.replay import Replay
from arm_gazebo.ros.contact_markers import TOPIC as CONTACT_TOPIC
from arm_gazebo.ros.contact_markers import contact_markers
from arm_gazebo.ros.world_markers import MOVED, TOPIC, marker_of
from arm_gazebo.run.robot import SimulatedRobot
from arm_gazebo.world.changes import WorldChanges
from arm_gazebo.world.contacts import contacts_of
from arm_gazebo.world.entity import WORLD_FRAME, Entities
from arm_gazebo.world.shapes import WorldShapes

CLOCK, TF, MARKERS, CONTACTS = "/clock", "/tf", f"/{TOPIC}", f"/{CONTACT_TOPIC}"


class ReplayedMessages:
    """Makes messages of a replay's present state, each by its topic; the replay's thread.

    Each link is a child of the frame `world`, where the replay has it; nothing is computed from
    the joint states.

    Args:
        replay: the replay.
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
