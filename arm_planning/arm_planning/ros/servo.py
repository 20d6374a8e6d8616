"""The node servo_node: its parameters and commands, those of moveit_servo, and its scene."""

import logging
import time
from collections.abc import Callable, Iterator
from dataclasses import dataclass
from typing import Any

import numpy as np
from control_msgs.msg import JointJog
from geometry_msgs.msg import PoseStamped, TwistStamped
from moveit_msgs.msg import PlanningScene as SceneMessage
from moveit_msgs.msg import ServoStatus
from moveit_msgs.srv import GetPlanningScene, ServoCommandType
from rclpy.clock import Clock
from rclpy.clock_type import ClockType
from rclpy.node import Node
from std_msgs.msg import Header
from std_srvs.srv import SetBool

from arm_node.names import describe_known
from arm_node.parameter_values import read_parameter
from arm_node.parameters import declare_typed, type_of
from arm_node.setting import Setting, read_settings, settings_of
from arm_planning.configuration import SERVO
from arm_planning.errors import InvalidRequestError, PlanningError
from arm_planning.robot.model import JointPositions, PlanningModel
from arm_planning.ros.answering import offer_service
from arm_planning.ros.convert import NANOSECONDS, pose_of, seconds, vector_of
from arm_planning.ros.convert_scene import scene_change_of
from arm_planning.ros.joint_state_monitor import JointStateMonitor
from arm_planning.ros.robot_setup import PlanningSetup, values_below
from arm_planning.ros.servo_output import ServoOutput
from arm_planning.scene.scene import PlanningScene
from arm_planning.scene.scene_changes import change_scene
from arm_planning.servo.commands import (
    CommandType,
    JogCommand,
    JointSpeeds,
    TipTarget,
    TipTwist,
)
from arm_planning.servo.jog import Jog
from arm_planning.servo.settings import ServoSettings
from arm_planning.servo.status import JogStatus, StatusCode

DEPTH = 10
SCENE_DEPTH = 100
POLLS = 4
"""How often in a period it is looked whether the period is over."""
IDLE_S = 0.5
"""Time between two statuses of a jog that does not move."""
WARN_EVERY_S = 1.0
STATES_STOPPED_S = 1.0
"""Age of the joint states from which nothing moves."""
FARTHEST_BEHIND = 0.3
"""How far a joint may be behind its command, rad or m."""
EARLY_S = 1e-6
LATE = 5
"""Periods that are caught up; after more the jog starts anew from the robot's state."""
NOT_USED = """
    active_subgroup apply_twist_commands_about_ee_frame cartesian_command_in_topic
    check_octomap_collisions collision_check_rate joint_command_in_topic joint_topic
    is_primary_planning_scene_monitor max_expected_latency monitored_planning_scene_topic
    pose_command_in_topic publish_joint_accelerations singularity_step_scale
    smoothing_filter_plugin_name status_topic thread_priority use_smoothing
    """
"""Parameters that moveit_servo has and this node does not need."""
LOGGER = logging.getLogger("servo_node")


@dataclass(frozen=True, slots=True)
class _Stamped:
    """A command and its time on the node's clock."""

    command: JogCommand
    stamp_s: float


class JogServer:
    """Jogs a robot as it is told. Executor's thread.

    Periods are those of the node's clock: simulation time, where it uses that. While nothing moves
    there is no command and hardly any work.
    """

    def __init__(self, node: Node, setup: PlanningSetup, settings: ServoSettings) -> None:
        self._node, self._settings = node, settings
        self._jog = Jog(setup.model, settings, setup.meshes)
        self._states = JointStateMonitor(node, setup.model)
        self._scene = ServoScene(node, setup.model, setup.scene)
        joints = self._jog.group.joints
        self._output = ServoOutput(node, joints, settings, self._jog.stop_s)
        self._type: CommandType | None = None
        self._is_paused = False
        self._stamped: _Stamped | None = None
        self._due_s = -np.inf
        self._warned_s = -np.inf
        self._status = node.create_publisher(ServoStatus, "~/status", DEPTH)
        node.create_subscription(TwistStamped, "~/delta_twist_cmds", self._take_twist, DEPTH)
        node.create_subscription(JointJog, "~/delta_joint_cmds", self._take_joints, DEPTH)
        node.create_subscription(PoseStamped, "~/pose_target_cmds", self._take_pose, DEPTH)
        offer_service(node, ServoCommandType, "~/switch_command_type", self._switch)
        offer_service(node, SetBool, "~/pause_servo", self._pause)
        steady = Clock(clock_type=ClockType.STEADY_TIME)
        poll_s = settings.publish_period_s / POLLS
        self._polling = node.create_timer(poll_s, self._go_on, clock=steady, autostart=False)
        node.create_timer(IDLE_S, self._look_around, clock=steady)

    def begin(self) -> None:
        """Say what is jogged."""
        LOGGER.info(
            "group '%s' is jogged: %s. Choose the commands with ~/switch_command_type",
            self._jog.group.name,
            ", ".join(self._jog.group.joints),
        )
        self._look_around()

    # Commands

    def _take_joints(self, message: JointJog) -> None:
        def read() -> JogCommand:
            joints = self._jog.group.joints
            if not message.joint_names:
                raise InvalidRequestError("the joint jog names no joint")
            if message.displacements:
                raise InvalidRequestError("displacements are not used: give velocities")
            return JointSpeeds.of(list(message.joint_names), list(message.velocities), joints)

        self._take(CommandType.JOINT_JOG, message.header, read)

    def _take_twist(self, message: TwistStamped) -> None:
        def read() -> JogCommand:
            linear = vector_of(message.twist.linear, "the linear velocity")
            angular = vector_of(message.twist.angular, "the angular velocity")
            return TipTwist(linear, angular, message.header.frame_id)

        self._take(CommandType.TWIST, message.header, read)

    def _take_pose(self, message: PoseStamped) -> None:
        def read() -> JogCommand:
            return TipTarget(pose_of(message.pose, "the target"), message.header.frame_id)

        self._take(CommandType.POSE, message.header, read)

    def _take(self, kind: CommandType, header: Header, read: Callable[[], JogCommand]) -> None:
        if self._is_paused:
            return
        try:
            command = self._checked(kind, seconds(header.stamp), read)
        except PlanningError as error:
            # A command that cannot be used ends the one before it, too.
            self._stamped = None
            self._refuse(str(error))
            return
        self._stamped = command
        if self._polling.is_canceled():
            self._polling.reset()
        self._go_on()

    def _checked(
        self, kind: CommandType, stamp_s: float, read: Callable[[], JogCommand]
    ) -> _Stamped:
        if self._type is None:
            raise InvalidRequestError("no command type is chosen yet: call ~/switch_command_type")
        if kind is not self._type:
            raise InvalidRequestError(
                f"a command of type {kind.name} came, but {self._type.name} is chosen: call "
                "~/switch_command_type"
            )
        age_s = self._now_s() - stamp_s
        if age_s >= self._settings.timeout_s:
            raise InvalidRequestError(
                f"the command's stamp is {age_s:.2f} s old, more than incoming_command_timeout: "
                f"{self._settings.timeout_s:g} s"
            )
        if age_s < -self._settings.timeout_s:
            raise InvalidRequestError(
                f"the command's stamp is {-age_s:.2f} s ahead of the robot's time: does its sender "
                "use simulation time?"
            )
        if self._output.problem:
            raise InvalidRequestError(self._output.problem)
        if missing := self._states.missing():
            raise InvalidRequestError(f"/joint_states has no position of {', '.join(missing)}")
        return _Stamped(read(), stamp_s)

    def _switch(
        self, request: ServoCommandType.Request, answer: ServoCommandType.Response
    ) -> ServoCommandType.Response:
        kinds = [kind.value for kind in CommandType]
        answer.success = request.command_type in kinds
        if answer.success:
            self._type, self._stamped = CommandType(request.command_type), None
            LOGGER.info("commands are of type %s", self._type.name)
        else:
            names = ", ".join(f"{kind.value} {kind.name}" for kind in CommandType)
            self._refuse(f"no command type {request.command_type}; there is {names}")
        return answer

    def _pause(self, request: SetBool.Request, answer: SetBool.Response) -> SetBool.Response:
        self._is_paused, self._stamped = request.data, None
        answer.success = True
        answer.message = "paused: commands are dropped" if request.data else "commands are taken"
        return answer

    # Periods

    def _now_s(self) -> float:
        self._states.positions()  # They bring the simulation's time.
        return self._node.get_clock().now().nanoseconds / NANOSECONDS

    def _go_on(self) -> None:
        """Make the steps that are due, and publish the last."""
        now_s = self._now_s()
        period_s = self._settings.publish_period_s
        if now_s < self._due_s - period_s - EARLY_S or now_s > self._due_s + LATE * period_s:
            # Time was set back or went on without the jog, so the robot is elsewhere.
            self._jog.halt()
            self._due_s = now_s
        if not self._jog.is_moving and now_s > self._due_s:
            self._due_s = now_s
        if now_s < self._due_s - EARLY_S:
            return
        command = self._fresh(now_s)
        if command is None and not self._jog.is_moving:
            self._polling.cancel()
            return
        try:
            self._step_until(now_s, command)
        except PlanningError as error:
            self._stamped = None
            self._jog.halt()
            self._refuse(str(error))

    def _fresh(self, now_s: float) -> JogCommand | None:
        if self._stamped is None or now_s - self._stamped.stamp_s >= self._settings.timeout_s:
            return None
        return self._stamped.command

    def _step_until(self, now_s: float, command: JogCommand | None) -> None:
        positions = self._states.positions()
        self._check_robot(positions, now_s)
        period_s = self._settings.publish_period_s
        step, before = None, self._jog.positions
        while self._due_s <= now_s + EARLY_S:
            if step is None and not self._jog.is_moving:
                before = self._jog.group.positions(positions)
            elif step is not None:
                before = step.positions
            step = self._jog.step(command, self._scene.scene, positions, period_s)
            self._due_s += period_s
            if not self._jog.is_moving:
                self._due_s = max(self._due_s, now_s + period_s)
        assert step is not None
        if step.is_moving:
            self._output.publish(before, step, self._due_s - period_s, period_s)
        self._say(step.status)

    def _check_robot(self, positions: JointPositions, now_s: float) -> None:
        """Raise a PlanningError if the robot does not follow, or is not heard any more."""
        group = self._jog.group
        age_s = now_s - self._states.stamp_s
        if age_s > STATES_STOPPED_S:
            raise InvalidRequestError(f"joint_states stopped {age_s:.1f} s ago")
        if self._jog.is_moving:
            behind = np.abs(self._jog.positions - group.positions(positions))
            if behind.max() > FARTHEST_BEHIND:
                raise InvalidRequestError(
                    f"joint {group.joints[int(behind.argmax())]} does not follow: it is "
                    f"{behind.max():.2f} behind its command"
                )

    def _look_around(self) -> None:
        """Look for what is not there yet, and say that nothing moves."""
        self._scene.ask()
        self._output.look_for_controller()
        if self._polling.is_canceled():
            self._say(JogStatus())

    def _say(self, status: JogStatus) -> None:
        self._status.publish(ServoStatus(code=int(status.code), message=status.message))

    def _refuse(self, sentence: str) -> None:
        self._say(JogStatus(StatusCode.INVALID, sentence))
        now_s = time.monotonic()
        if now_s - self._warned_s >= WARN_EVERY_S:
            self._warned_s = now_s
            LOGGER.warning("%s", sentence)


class ServoScene:
    """Follows the scene that move_group publishes. Executor's thread.

    Attributes:
        scene: the scene; the same object until something in it changes but the robot's state.
    """

    def __init__(self, node: Node, model: PlanningModel, scene: PlanningScene) -> None:
        self.scene = scene
        self._model = model
        self._is_asked = False
        self._client = node.create_client(GetPlanningScene, "get_planning_scene")
        node.create_subscription(SceneMessage, "monitored_planning_scene", self._take, SCENE_DEPTH)

    def ask(self) -> None:
        """Ask move_group for its scene once it is there: it publishes changes only."""
        if self._is_asked or not self._client.service_is_ready():
            return
        self._is_asked = True
        asked = self._client.call_async(GetPlanningScene.Request())
        asked.add_done_callback(self._take_answer)

    def _take_answer(self, future: Any) -> None:
        if (answer := future.result()) is not None:
            self._take(answer.scene)

    def _take(self, message: SceneMessage) -> None:
        if message.is_diff and not _changes_more_than_the_state(message):
            return
        try:
            change = scene_change_of(self._model, message, LOGGER.warning)
            self.scene = change_scene(self._model, self.scene, change, LOGGER.warning).scene
        except PlanningError as error:
            LOGGER.error("the planning scene cannot be used: %s", error)


def _changes_more_than_the_state(message: SceneMessage) -> bool:
    return bool(
        message.world.collision_objects
        or message.world.octomap.octomap.id
        or message.robot_state.attached_collision_objects
        or message.allowed_collision_matrix.entry_names
        or message.fixed_frame_transforms
        or message.link_padding
        or message.link_scale
    )


def read_servo_settings(node: Node) -> ServoSettings:
    """Return the settings; a name that moveit_servo does not have is warned of.

    Raises:
        ParameterValueError: a value is invalid.
    """

    def value(each: Setting) -> Any:
        given = node.has_parameter(each.name)
        own = node.get_parameter(each.name).value if given else each.default
        found = read_parameter(each.name, own, each.read)
        if not given:
            kind, read_only = type_of(each.default), not each.changes
            declare_typed(node, each.name, kind, own, each.about, read_only=read_only)
        return found

    settings = read_settings(ServoSettings, value, f"{SERVO}.")
    for warning in unknown_names(set(values_below(node, SERVO))):
        LOGGER.warning("%s", warning)
    return settings


def unknown_names(names: set[str]) -> Iterator[str]:
    """Yield a sentence for each parameter that moveit_servo does not have."""
    known = {each.name for each in settings_of(ServoSettings)}
    for name in sorted(names - known):
        if name.partition(".")[0] in NOT_USED.split():
            continue
        yield f"there is no parameter {SERVO}.{name}; {describe_known(name, known)}"
