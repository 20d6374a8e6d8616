"""The commands that move joints through their controllers."""

from types import MappingProxyType

import pytest
from robots import joint, link, robot

from arm_description.urdf.parser import parse_urdf
from arm_viewer.joint_move import SPEED_USED, DriveKind, joint_drives, plan_moves
from arm_viewer.requests import MoveJoints
from arm_viewer.snapshot import Description, JointReading, JointStates, ListedController, Snapshot

ROBOT = robot(
    *(link(name, mass=0) for name in ("base", "a", "b")),
    joint("j0", "base", "a", limits=(-2, 2), effort=1, velocity=0.5),
    joint("j1", "a", "b", limits=(-2, 2), effort=1, velocity=2),
)
POSITIONS = "position_controllers/JointGroupPositionController"
TRAJECTORIES = "joint_trajectory_controller/JointTrajectoryController"


def controller(kind=POSITIONS, state="active", namespace="", joints=("j1", "j0"), **more):
    fields = {
        "manager": f"{namespace}/controller_manager",
        "name": "arm",
        "type": kind,
        "state": state,
        "claimed": ("j0/position", "j1/position"),
        "joints": joints,
    }
    return ListedController(**{**fields, **more})


def snapshot(*controllers, namespace="", at=(0.1, 0.2), commands=()):
    description = Description(f"{namespace}/robot_description", namespace, parse_urdf(ROBOT))
    readings = {f"j{i}": JointReading(q, 0.0, 0.0) for i, q in enumerate(at)}
    return Snapshot(
        descriptions=MappingProxyType({description.topic: description}),
        joint_states=MappingProxyType(
            {f"{namespace}/joint_states": JointStates(MappingProxyType(readings), 0.0)}
        ),
        controllers=tuple(controllers),
        commands=MappingProxyType({namespace: dict(commands), "/other": {"j1/position": 0.19}}),
    )


def test_positions_are_in_the_order_of_the_controller_s_parameter():
    (move,) = plan_moves(snapshot(controller()), MoveJoints("", {"j0": 1.0}))
    assert move.drive.name == "/arm/commands"
    assert move.drive.joints == ("j1", "j0")
    assert move.positions == (0.2, 1.0)


def test_without_the_parameter_the_claimed_interfaces_say_the_order():
    (drive,) = joint_drives([controller(joints=())], "")
    assert drive.joints == ("j0", "j1")


def test_a_sagging_joint_is_held_at_its_last_command():
    told = {"j1/position": 0.21}
    (move,) = plan_moves(snapshot(controller(), commands=told), MoveJoints("", {"j0": 1.0}))
    assert move.positions == (0.21, 1.0)


def test_a_joint_far_from_its_last_command_is_held_at_its_position():
    told = {"j1/position": 1.5}
    (move,) = plan_moves(snapshot(controller(), commands=told), MoveJoints("", {"j0": 1.0}))
    assert move.positions == (0.2, 1.0)


def test_a_trajectory_takes_the_time_that_the_slowest_joint_needs():
    (move,) = plan_moves(snapshot(controller(TRAJECTORIES)), MoveJoints("", {"j0": 1.1, "j1": 1.2}))
    assert move.drive.kind is DriveKind.TRAJECTORY
    assert move.drive.name == "/arm/joint_trajectory"
    assert move.duration_s == pytest.approx(1.0 / (SPEED_USED * 0.5))


def test_each_robot_has_its_own_namespace():
    here, there = controller(namespace="/left"), controller(namespace="/right")
    shown = snapshot(here, there, namespace="/left")
    (move,) = plan_moves(shown, MoveJoints("/left", {"j0": 1.0}))
    assert move.drive.name == "/left/arm/commands"


@pytest.mark.parametrize(
    "other",
    [
        controller(state="inactive"),
        controller("effort_controllers/JointGroupEffortController"),
        controller(claimed=()),
        controller(claimed=("j0/position", "j0/velocity")),
        controller(joints=("j0", "j9"), claimed=("j0/position", "j9/position")),
    ],
)
def test_nothing_is_sent_without_an_active_controller_for_positions_of_known_joints(other):
    assert plan_moves(snapshot(other), MoveJoints("", {"j0": 1.0})) == ()


def test_a_controller_of_other_joints_is_left_alone():
    assert plan_moves(snapshot(controller()), MoveJoints("", {"j7": 1.0})) == ()


@pytest.mark.parametrize(
    ("kind", "claimed", "drive"),
    [
        ("position_controllers", ("j1/position", "j1/max_effort"), DriveKind.GRIPPER),
        ("effort_controllers", ("j1/effort",), DriveKind.GRIPPER),
        ("parallel_gripper_action_controller", ("j1/position",), DriveKind.PARALLEL_GRIPPER),
    ],
)
def test_a_gripper_takes_the_position_of_its_joint_as_a_goal(kind, claimed, drive):
    gripper = controller(f"{kind}/GripperActionController", claimed=claimed, joints=())
    (move,) = plan_moves(snapshot(gripper), MoveJoints("", {"j1": 0.5}))
    assert (move.drive.kind, move.drive.name) == (drive, "/arm/gripper_cmd")
    assert (move.drive.joints, move.positions) == (("j1",), (0.5,))


def test_single_joints_of_ros_1():
    one = controller(
        "position_controllers/JointPositionController",
        name="j0p_controller",
        claimed=("j0/position",),
        joints=(),
    )
    (move,) = plan_moves(snapshot(one), MoveJoints("", {"j0": 1.0}))
    assert (move.drive.name, move.positions) == ("/j0p_controller/command", (1.0,))
