"""The client of servo_node that `arm teleop` moves the robot with."""

from dataclasses import dataclass

from builtin_interfaces.msg import Time
from control_msgs.msg import JointJog
from geometry_msgs.msg import TwistStamped, Vector3
from moveit_msgs.msg import ServoStatus
from moveit_msgs.srv import ServoCommandType
from sensor_msgs.msg import JointState, Joy

from arm_cli.errors import UnansweredError
from arm_cli.ros.graph import NodeName
from arm_cli.ros.move_group import MoveGroupClient
from arm_cli.ros.parameters import NodeParameters, content_of
from arm_cli.ros.service_call import call_service
from arm_cli.ros.session import CommandSession
from arm_cli.teleop.motions import JointMotion, Motion, TipMotion, gamepad_motion
from arm_node.qos import NEWEST
from arm_planning.errors import PlanningError
from arm_planning.robot.model import JointGroup
from arm_planning.servo.settings import SPEED_UNITS

NODE = "/servo_node"
TIMEOUT_S = 5.0
PREFIX = "moveit_servo"
UNITS, SCALES = "command_in_type", ("scale.linear", "scale.rotational", "scale.joint")
SWITCH = f"{NODE}/switch_command_type"
GAMEPAD_TIMEOUT_S = 0.25
"""joy_node repeats an unchanged state every 50 ms."""


@dataclass(frozen=True, slots=True)
class _Scales:
    """What a full speed is in a command."""

    linear: float = 1.0
    angular: float = 1.0
    joint: float = 1.0


class JogClient:
    """Sends motions to servo_node, stamped with the robot's time.

    Attributes:
        group: the joints that are jogged.
        status: what servo_node said last; empty if all is well.
        problem: what is wrong with the gamepad; empty if nothing is.
    """

    def __init__(self, session: CommandSession) -> None:
        """Find servo_node.

        Raises:
            UnansweredError: it does not run, or nothing publishes the robot's state.
        """
        self._session = session
        self.status = self.problem = ""
        node = session.node
        switch = node.create_client(ServoCommandType, SWITCH)
        there = session.wait_until(switch.service_is_ready, timeout_s=TIMEOUT_S)
        node.destroy_client(switch)
        if not there:
            raise UnansweredError(
                "no servo_node runs: start the robot with servo:=true, as in "
                "`arm launch mycobot planning:=true servo:=true`"
            )
        self.group, self._scales = self._what_is_jogged()
        self._joints = node.create_publisher(JointJog, f"{NODE}/delta_joint_cmds", 10)
        self._twists = node.create_publisher(TwistStamped, f"{NODE}/delta_twist_cmds", 10)
        self._type: int | None = None
        self._state: JointState | None = None
        self._gamepad: tuple[float, TipMotion] | None = None
        node.create_subscription(JointState, "/joint_states", self._take_state, NEWEST)
        node.create_subscription(ServoStatus, f"{NODE}/status", self._take_status, 10)
        node.create_subscription(Joy, "/joy", self._take_gamepad, NEWEST)
        if not session.wait_until(lambda: self._state is not None, timeout_s=TIMEOUT_S):
            raise UnansweredError("nobody publishes /joint_states, so no command can be stamped")

    def _what_is_jogged(self) -> tuple[JointGroup, _Scales]:
        names = [f"{PREFIX}.{name}" for name in ("move_group_name", UNITS, *SCALES)]
        values = NodeParameters(self._session, NodeName.of(NODE)).values(names)
        if len(values) < len(names):
            raise UnansweredError(f"{NODE} does not have the parameters {', '.join(names)}")
        name, units, *scales = map(content_of, values)
        model = MoveGroupClient(self._session, "/").model()
        try:
            group = model.group(name) if name else model.default_group()
        except PlanningError as error:
            raise UnansweredError(str(error)) from error
        return group, _Scales(*scales) if units == SPEED_UNITS else _Scales()

    def _take_state(self, message: JointState) -> None:
        self._state = message

    def _take_status(self, message: ServoStatus) -> None:
        self.status = message.message if message.code else ""

    def _take_gamepad(self, message: Joy) -> None:
        self._gamepad, self.problem = None, ""
        try:
            motion = gamepad_motion(list(message.axes), list(message.buttons))
        except ValueError as error:
            self.problem = str(error)
            return
        if motion is not None:
            self._gamepad = self._session.clock_s(), motion

    def gamepad(self) -> TipMotion | None:
        """Return what a gamepad asks for; None without one, or if it is not heard any more."""
        if self._gamepad is None or self._session.clock_s() - self._gamepad[0] > GAMEPAD_TIMEOUT_S:
            return None
        return self._gamepad[1]

    def send(self, motion: Motion, in_tip_frame: bool) -> None:
        """Send a motion, which holds for servo_node's incoming_command_timeout.

        Raises:
            UnansweredError: servo_node has gone.
        """
        if isinstance(motion, JointMotion):
            self._choose(ServoCommandType.Request.JOINT_JOG)
            speed = motion.speed * self._scales.joint
            jog = JointJog(joint_names=[motion.joint], velocities=[speed])
            jog.header.stamp = self._stamp()
            self._joints.publish(jog)
            return
        self._choose(ServoCommandType.Request.TWIST)
        twist = TwistStamped()
        twist.header.stamp = self._stamp()
        twist.header.frame_id = self.group.tip if in_tip_frame else ""
        twist.twist.linear = _vector(motion.linear, self._scales.linear)
        twist.twist.angular = _vector(motion.angular, self._scales.angular)
        self._twists.publish(twist)

    def _choose(self, kind: int) -> None:
        if self._type != kind:
            request = ServoCommandType.Request(command_type=kind)
            call_service(self._session, ServoCommandType, SWITCH, request, TIMEOUT_S, TIMEOUT_S)
            self._type = kind

    def _stamp(self) -> Time:
        assert self._state is not None
        return self._state.header.stamp


def _vector(values: tuple[float, float, float], scale: float) -> Vector3:
    x, y, z = values
    return Vector3(x=x * scale, y=y * scale, z=z * scale)
