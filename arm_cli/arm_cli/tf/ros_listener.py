"""Listens to /tf and /tf_static until the frames are known."""

from functools import partial

from rclpy.qos import DurabilityPolicy, QoSProfile, qos_profile_sensor_data
from rosgraph_msgs.msg import Clock
from tf2_msgs.msg import TFMessage

from arm_cli.errors import UnansweredError
from arm_cli.names import this_domain
from arm_cli.ros.session import CommandSession
from arm_cli.tf.frame_log import FrameLog
from arm_node.rigid_transform import RigidTransform

FIRST_TIMEOUT_S = 10.0


def listen(
    session: CommandSession, duration_s: float, timeout_s: float | None = FIRST_TIMEOUT_S
) -> FrameLog:
    """Return the frames received within a duration after the first transform.

    Without a timeout it waits for ever for the first one.

    Raises:
        UnansweredError: nobody publishes transforms.
    """
    log = _collected(session)
    received = session.wait_until(
        lambda: bool(log.frames),
        lambda: f"waiting for transforms on /tf and /tf_static, {this_domain()}",
        timeout_s,
    )
    if not received:
        raise UnansweredError(f"no transforms on /tf or /tf_static within {timeout_s:g} s")
    session.spin_for(duration_s)
    return log


def _collected(session: CommandSession) -> FrameLog:
    """Return a log to which all transforms are added that the session's node receives.

    Their delays are by /clock where somebody publishes it.
    """
    log = FrameLog()
    simulated_s: list[float] = []

    def take_clock(message: Clock) -> None:
        simulated_s[:] = [message.clock.sec + message.clock.nanosec * 1e-9]

    def take(message: TFMessage, static: bool) -> None:
        now_s = simulated_s[0] if simulated_s else session.clock_s()
        for transform in message.transforms:
            stamp = transform.header.stamp
            stamp_s = stamp.sec + stamp.nanosec * 1e-9
            translation, rotation = transform.transform.translation, transform.transform.rotation
            log.add(
                transform.header.frame_id,
                transform.child_frame_id,
                stamp_s,
                RigidTransform(
                    (translation.x, translation.y, translation.z),
                    (rotation.x, rotation.y, rotation.z, rotation.w),
                ),
                static,
                max(0.0, now_s - stamp_s),
            )

    session.node.create_subscription(Clock, "/clock", take_clock, qos_profile_sensor_data)
    latched = QoSProfile(depth=100, durability=DurabilityPolicy.TRANSIENT_LOCAL)
    session.node.create_subscription(TFMessage, "/tf", partial(take, static=False), 100)
    session.node.create_subscription(TFMessage, "/tf_static", partial(take, static=True), latched)
    return log
