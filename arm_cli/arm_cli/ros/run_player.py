"""Publishes a replayed run: clock, joint states, transforms and descriptions."""

import time
from collections.abc import Sequence

import numpy as np
from builtin_interfaces.msg import Time
from geometry_msgs.msg import Quaternion, Transform, TransformStamped, Vector3
from rclpy.qos import DurabilityPolicy, QoSProfile
from rosgraph_msgs.msg import Clock
from sensor_msgs.msg import JointState
from std_msgs.msg import Header, String
from tf2_msgs.msg import TFMessage

from arm_cli.ros.session import CommandSession
from arm_gazebo.recording.replay import Replay

PUBLISH_PERIOD_S = 0.02
HOLD_PERIOD_S = 0.1
WORLD = "world"
LATCHED = QoSProfile(depth=1, durability=DurabilityPolicy.TRANSIENT_LOCAL)


class RunPlayer:
    """Shows a replay to ROS tools, at a pace. Use it in the session's thread.

    Each link is a child of the frame `world`, where the replay has it; nothing is computed from
    the joint states.

    Args:
        session: its node publishes.
        replay: the replay, before its first period.
        speed: simulated seconds for each second of wall time.
    """

    def __init__(self, session: CommandSession, replay: Replay, speed: float) -> None:
        node = session.node
        self._session = session
        self._replay = replay
        self._speed = speed
        self._clock = node.create_publisher(Clock, "/clock", 10)
        self._transforms = node.create_publisher(TFMessage, "/tf", 100)
        self._states = []
        for robot in replay.robots:
            namespace = robot.manager.name.rpartition("/")[0]
            description = node.create_publisher(String, f"{namespace}/robot_description", LATCHED)
            description.publish(String(data=robot.document.text))
            self._states.append(node.create_publisher(JointState, f"{namespace}/joint_states", 10))
        self._started_s = time.monotonic()
        self._first_s = replay.simulation.time_s
        self._next_s = 0.0

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
        nanoseconds = round(self._replay.simulation.time_s * 1e9)
        stamp = Time(sec=nanoseconds // 10**9, nanosec=nanoseconds % 10**9)
        self._clock.publish(Clock(clock=stamp))
        for robot, publisher in zip(self._replay.robots, self._states, strict=True):
            measured = (name.rpartition("/") for name in robot.manager.resources.state_names)
            names = [joint for joint, _, kind in measured if kind == "position"]
            publisher.publish(self._joint_state(names, stamp))
        self._transforms.publish(self._tf(stamp))

    def _joint_state(self, names: Sequence[str], stamp: Time) -> JointState:
        joints = self._replay.simulation.built.joints
        data = self._replay.simulation.data
        known = [joints[name] for name in names if name in joints]
        dofs = np.array([joint.dof_address for joint in known], dtype=np.intp)
        return JointState(
            header=Header(stamp=stamp),
            name=[joint.name for joint in known],
            position=[float(data.qpos[joint.qpos_address]) for joint in known],
            velocity=data.qvel[dofs].tolist(),
            effort=data.qfrc_actuator[dofs].tolist(),
        )

    def _tf(self, stamp: Time) -> TFMessage:
        # The poses in MuJoCo's own data belong to the state before the last step.
        data = self._replay.simulation.observe()
        transforms: list[TransformStamped] = []
        for link, body in self._replay.simulation.built.bodies.items():
            if link == WORLD:
                continue
            x, y, z = data.xpos[body].tolist()
            qw, qx, qy, qz = data.xquat[body].tolist()
            pose = Transform(
                translation=Vector3(x=x, y=y, z=z), rotation=Quaternion(x=qx, y=qy, z=qz, w=qw)
            )
            header = Header(stamp=stamp, frame_id=WORLD)
            transforms.append(TransformStamped(header=header, child_frame_id=link, transform=pose))
        return TFMessage(transforms=transforms)
