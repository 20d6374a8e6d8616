"""servo_node beside move_group, jogged as moveit_servo's clients do it."""

import os
import sys
from collections.abc import Callable, Iterator
from contextlib import contextmanager
from typing import Any

import pytest
from control_msgs.msg import JointJog
from geometry_msgs.msg import TwistStamped
from moveit_msgs.msg import ServoStatus
from moveit_msgs.srv import GetPositionFK, ServoCommandType
from programs import Program
from sensor_msgs.msg import JointState, Joy
from std_srvs.srv import SetBool
from trajectory_msgs.msg import JointTrajectory

INVALID, FINE, DECELERATE_FOR_COLLISION, HALT_FOR_COLLISION = -1, 0, 4, 5
JOINT_JOG, TWIST = 0, 1
BASE = "link1_to_link2"


@pytest.fixture(scope="module")
def launched(launch_for_file) -> Program:
    """Return the simulation with move_group and servo_node, ready."""
    program = launch_for_file("mycobot", "planning:=true", "servo:=true")
    program.wait_until_ready()
    program.wait_for_line("commands go to /arm_controller/joint_trajectory")
    return program


class JogClient:
    """A client of servo_node that holds keys down."""

    def __init__(self, planning: Any) -> None:
        client = planning.client
        self.planning, self.client = planning, client
        self.statuses = client.subscribe(ServoStatus, "/servo_node/status")
        self.trajectories = client.subscribe(JointTrajectory, "/arm_controller/joint_trajectory")
        self.joints = client.publisher(JointJog, "/servo_node/delta_joint_cmds")
        self.twists = client.publisher(TwistStamped, "/servo_node/delta_twist_cmds")

    def switch(self, kind: int) -> bool:
        request = ServoCommandType.Request(command_type=kind)
        name = "/servo_node/switch_command_type"
        return self.client.call(ServoCommandType, name, request).success

    def joint_jog(self, joint: str, speed: float) -> Any:
        return JointJog(joint_names=[joint], velocities=[speed])

    def twist(self, z: float, frame: str = "") -> Any:
        message = TwistStamped()
        message.header.frame_id, message.twist.linear.z = frame, z
        return message

    @contextmanager
    def held(self, command: Any) -> Iterator[None]:
        """Send a command with each joint state, in whose time it is stamped."""
        publisher = self.joints if hasattr(command, "joint_names") else self.twists

        def send(state: JointState) -> None:
            command.header.stamp = state.header.stamp
            publisher.publish(command)

        subscription = self.client.node.create_subscription(JointState, "/joint_states", send, 10)
        try:
            yield
        finally:
            self.client.run(
                lambda: self.client.node.destroy_subscription(subscription), "the end of a key"
            )

    def is_refused(self, command: Any, sentence: str) -> None:
        """Hold a command down until the status says why it is not used."""
        self.statuses.clear()
        with self.held(command):
            self.status(INVALID, sentence)

    def status(self, code: int, part: str = "") -> None:
        """Wait for a status."""
        self.statuses.wait_until(
            lambda m: any(each.code == code and part in each.message for each in m),
            f"status {code} with '{part}'",
        )

    def tip(self) -> Any:
        """Return where the gripper is in the planning frame."""
        request = GetPositionFK.Request(fk_link_names=["gripper_base"])
        positions = self.planning.positions()
        request.robot_state.joint_state.name = list(positions)
        request.robot_state.joint_state.position = list(positions.values())
        return self.planning.call("/compute_fk", request).pose_stamped[0].pose.position

    def position(self, joint: str) -> float:
        return self.planning.positions()[joint]


@pytest.fixture(scope="module")
def jog(planning_for_file) -> JogClient:
    """Return the client of the whole file."""
    return JogClient(planning_for_file)


def test_before_a_type_is_chosen_nothing_moves_and_the_status_says_why(jog):
    jog.is_refused(jog.joint_jog(BASE, 1.0), "no command type is chosen yet")
    assert not jog.switch(7)
    assert not jog.trajectories.messages


def test_a_joint_moves_while_commands_come_and_then_nothing_is_commanded(jog, launched):
    assert jog.switch(JOINT_JOG)
    with jog.held(jog.joint_jog(BASE, 0.8)):
        jog.planning.joint_moves(BASE, 0.2)
    jog.planning.stands_still()

    def is_silent() -> bool:
        jog.trajectories.clear()
        jog.planning.joint_states.clear()
        jog.planning.joint_states.wait_for(50)
        return not jog.trajectories.messages

    jog.client.wait_until(is_silent, "no commands after the end of the motion")
    assert jog.position(BASE) > 0.2


def test_a_twist_lowers_the_tip_along_a_frame_of_the_scene(
    jog, planning, joint_goal, request_of, joints
):
    bent = joint_goal(joints(0.0, -0.5, 1.57, 0.6, 0.3))
    assert planning.move(request_of(bent)).result.error_code.val == 1
    before = jog.tip()
    assert jog.switch(TWIST)
    with jog.held(jog.twist(-0.3, "base_link")):
        jog.planning.joint_moves("link3_to_link4", 0.05)
    jog.planning.stands_still()
    after = jog.tip()
    assert after.z < before.z - 0.002
    assert abs(after.x - before.x) + abs(after.y - before.y) < 0.5 * (before.z - after.z)


def test_it_stops_before_an_object_of_the_scene_and_the_way_back_is_open(
    jog, planning, box, joint_goal, request_of, joints
):
    assert planning.move(request_of(joint_goal(joints(0.0, -1.2)))).result.error_code.val == 1
    assert planning.apply_object(box("post", (0.2, 0.25, 0.25), (0.04, 0.04, 0.6)))
    assert jog.switch(JOINT_JOG)
    jog.statuses.clear()
    with jog.held(jog.joint_jog(BASE, -1.0)):
        stopped = jog.statuses.wait_until(
            lambda m: any("post" in each.message for each in m), "the post"
        )
        # It comes ever nearer, and ever slower: here at a fiftieth of what is commanded.
        planning.stands_still(within=0.004)
    assert planning.is_free(planning.positions())
    codes = {each.code for each in stopped if "post" in each.message}
    assert codes <= {DECELERATE_FOR_COLLISION, HALT_FOR_COLLISION}
    with jog.held(jog.joint_jog(BASE, 1.0)):
        planning.joint_moves(BASE, 0.1)
        jog.statuses.clear()
        jog.status(FINE)


def test_what_cannot_be_used_does_not_move_the_robot(jog):
    assert jog.switch(JOINT_JOG)
    before = jog.planning.stands_still()
    jog.is_refused(jog.joint_jog("elbow", 1.0), "no joint 'elbow'; ")
    jog.is_refused(jog.joint_jog(BASE, float("nan")), f"the velocity of '{BASE}' is nan")
    jog.is_refused(jog.twist(0.5), "a command of type TWIST came, but JOINT_JOG is chosen")
    assert jog.switch(TWIST)
    jog.is_refused(jog.twist(0.5, "gripper_bas"), "Unknown frame: gripper_bas")
    jog.statuses.clear()
    jog.twists.publish(jog.twist(0.5))
    jog.status(INVALID, "the command's stamp is")
    assert jog.planning.stands_still() == pytest.approx(before, abs=1e-3)


def test_a_paused_jog_drops_commands_until_it_goes_on(jog):
    assert jog.switch(JOINT_JOG)
    before = jog.planning.stands_still()
    assert jog.client.call(
        SetBool, "/servo_node/pause_servo", SetBool.Request(data=True)
    ).message.startswith("paused")
    with jog.held(jog.joint_jog(BASE, 0.5)):
        jog.planning.joint_states.clear()
        jog.planning.joint_states.wait_for(50)
        assert jog.position(BASE) == pytest.approx(before[BASE], abs=1e-3)
        jog.client.call(SetBool, "/servo_node/pause_servo", SetBool.Request(data=False))
        jog.planning.joint_moves(BASE, 0.05)


@contextmanager
def teleop() -> Iterator[tuple[Program, Callable[[str], None]]]:
    """Yield `arm teleop` on a terminal, and a function that types."""
    keyboard, terminal = os.openpty()
    program = Program([sys.executable, "-m", "arm_cli", "teleop"], stdin=terminal)
    try:
        program.wait_for_line("speed 50%")
        yield program, lambda keys: os.write(keyboard, keys.encode()) and None
    finally:
        program.close()
        os.close(keyboard)
        os.close(terminal)


def test_keys_jog_a_joint_and_space_stops_the_robot(jog):
    before = jog.planning.stands_still()[BASE]
    with teleop() as (program, press):

        def is_turned() -> bool:
            press("1")
            jog.planning.joint_states.clear()
            jog.planning.joint_states.wait_for(1)
            return jog.position(BASE) > before + 0.1

        jog.client.wait_until(is_turned, "the joint that the key 1 turns")
        jog.planning.stands_still()
        press(" ")
        program.wait_for_line("/emergency_stop: stopped")
        press("q")
        program.succeed()
    request = SetBool.Request(data=False)
    assert jog.client.call(SetBool, "/emergency_stop", request).success


def test_a_gamepad_moves_the_tip_while_its_button_is_held(
    jog, planning, joint_goal, request_of, joints
):
    bent = joint_goal(joints(0.0, -0.5, 1.57, 0.6, 0.3))
    assert planning.move(request_of(bent)).result.error_code.val == 1
    before = jog.tip()
    with teleop() as (program, press):
        pads = jog.client.node.create_publisher(Joy, "/joy", 10)

        def is_lowered() -> bool:
            pads.publish(Joy(axes=[0.0] * 4 + [-1.0] + [0.0] * 3, buttons=[0, 0, 0, 0, 1]))
            jog.planning.joint_states.clear()
            jog.planning.joint_states.wait_for(1)
            return jog.tip().z < before.z - 0.01

        jog.client.wait_until(is_lowered, "the tip that the right stick lowers")
        pads.publish(Joy(axes=[0.0], buttons=[]))
        program.wait_for_line("the gamepad has 1 axes and 0 buttons")
        press("q")
        program.succeed()
