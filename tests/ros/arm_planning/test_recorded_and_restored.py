"""Planned motions in a simulation that is recorded, saved, restored and reset meanwhile."""

import sys
from contextlib import closing
from typing import Any

import pytest
from moveit_msgs.msg import AttachedCollisionObject, CollisionObject, PlanningScene
from moveit_msgs.srv import LoadGeometryFromFile, SaveGeometryToFile
from programs import RosProgram
from simulated import OK, Simulated

SUCCESS, CONTROL_FAILED = 1, -4
SUCCEEDED, ABORTED = 4, 6
SCOPE_TIME, SCOPE_ALL = 1, 255
TURN = "link1_to_link2"
SLOW = {"max_velocity_scaling_factor": 0.1}
"""A turn by 2 rad takes 7 s of the robot's time."""
NEAR = 0.02
CAN = "coke_can"
WORLD = "world_"
"""The shapes of the world itself; the robot has a link `world`."""


def arm(*words: str) -> str:
    with closing(RosProgram([sys.executable, "-m", "arm_cli", *words])) as program:
        return program.succeed()


@pytest.fixture(scope="module")
def launched(launch_for_file):
    program = launch_for_file("mycobot", "planning:=true", "scene_from_world:=true")
    program.wait_until_ready()
    return program


@pytest.fixture
def planning(planning_for_file):
    """Return the client; the scene has the world's things."""
    return planning_for_file


@pytest.fixture
def run(planning):
    return Simulated(planning.client)


@pytest.fixture
def turn_to(request_of, joint_goal, joints):
    """Return a function that makes a request to turn the arm, above all things, to an angle."""

    def make(angle: float, **fields: Any) -> Any:
        return request_of(joint_goal(joints(angle, -0.3)), **fields)

    return make


@pytest.fixture
def at_the_start(planning, turn_to):
    """Move the arm to the start of a turn, whatever was before."""
    planning.stands_still()
    succeed(planning.move(turn_to(-1.0)))


def succeed(ended: Any) -> None:
    assert ended.result.error_code.val == SUCCESS, ended.result.error_code.message
    assert ended.status == SUCCEEDED


def place_of(planning: Any, name: str) -> list[float]:
    """Return where an object of the scene is."""
    found = {each.id: each.pose.position for each in planning.scene().world.collision_objects}
    return [found[name].x, found[name].y, found[name].z]


def is_at(planning: Any, name: str, place: list[float]) -> bool:
    return place_of(planning, name) == pytest.approx(place, abs=NEAR)


def attach(planning: Any, name: str, *, detach: bool = False) -> None:
    held = AttachedCollisionObject(link_name="gripper_base", touch_links=[WORLD])
    held.object.id = name
    held.object.operation = CollisionObject.REMOVE if detach else CollisionObject.ADD
    scene = PlanningScene(is_diff=True)
    scene.robot_state.is_diff = True
    scene.robot_state.attached_collision_objects = [held]
    assert planning.apply(scene)


# Recorded runs


def test_a_run_with_planned_motions_repeats_to_the_last_bit(
    planning, run, at_the_start, turn_to, tmp_path
):
    path = str(tmp_path / "planned.run")
    assert run.set(record_run=path) == ""
    succeed(planning.move(turn_to(0.4)))
    cancelled = planning.start_move(turn_to(-1.0, **SLOW))
    planning.joint_moves(TURN, by=0.05)
    cancelled.cancel()
    cancelled.end()
    assert run.snapshot("save", "recorded").result == OK
    restored = planning.start_move(turn_to(-1.0, **SLOW))
    planning.joint_moves(TURN, by=0.05)
    assert run.snapshot("restore", "recorded").result == OK
    restored.end()
    succeed(planning.move(turn_to(0.6)))
    assert run.set(record_run="") == ""
    assert "control periods are equal" in arm("sim", "replay", path)


# Snapshots


def test_a_motion_that_a_snapshot_has_goes_on_from_there(planning, run, at_the_start, turn_to):
    goal = planning.start_move(turn_to(1.0, **SLOW))
    planning.joint_moves(TURN, by=0.1)
    assert run.snapshot("save", "moving").result == OK
    saved = planning.positions()[TURN]
    planning.joint_moves(TURN, by=0.4)
    assert run.snapshot("restore", "moving").result == OK
    assert planning.positions()[TURN] < saved + 0.3
    succeed(goal.end())
    assert planning.positions()[TURN] == pytest.approx(1.0, abs=NEAR)


def test_a_snapshot_without_the_motion_ends_it_and_says_so(planning, run, at_the_start, turn_to):
    assert run.snapshot("save", "still").result == OK
    goal = planning.start_move(turn_to(1.0, **SLOW))
    planning.joint_moves(TURN, by=0.2)
    assert run.snapshot("restore", "still").result == OK
    ended = goal.end()
    assert (ended.status, ended.result.error_code.val) == (ABORTED, CONTROL_FAILED)
    assert "the simulation was restored" in ended.result.error_code.message
    assert planning.positions()[TURN] == pytest.approx(-1.0, abs=NEAR)
    succeed(planning.move(turn_to(-0.5)))


def test_things_in_the_scene_are_where_the_snapshot_has_them(planning, run, at_the_start):
    before = place_of(planning, CAN)
    assert run.snapshot("save", "things").result == OK
    run.move(CAN, 0.1, 0.5, 0.1)
    planning.client.wait_until(lambda: place_of(planning, CAN)[1] > 0.4, "the can elsewhere")
    assert run.snapshot("restore", "things").result == OK
    planning.client.wait_until(lambda: is_at(planning, CAN, before), "the can back")
    assert is_at(planning, CAN, before)


def test_a_thing_that_was_held_follows_the_simulation_again(planning, run, at_the_start, turn_to):
    assert run.snapshot("save", "before").result == OK
    before = place_of(planning, CAN)
    attach(planning, CAN)
    succeed(planning.move(turn_to(-0.8)))
    (held,) = planning.scene().robot_state.attached_collision_objects
    assert held.object.id == CAN
    assert run.snapshot("restore", "before").result == OK
    # What clients told move_group is not in a snapshot.
    (held,) = planning.scene().robot_state.attached_collision_objects
    assert held.object.id == CAN
    attach(planning, CAN, detach=True)
    assert is_at(planning, CAN, before)
    assert not planning.scene().robot_state.attached_collision_objects


# Resets


@pytest.mark.parametrize("keeps_clock", [False, True])
def test_a_reset_ends_a_motion_and_says_so(planning, run, at_the_start, turn_to, keeps_clock):
    goal = planning.start_move(turn_to(1.0, **SLOW))
    planning.joint_moves(TURN, by=0.2)
    assert run.set(reset_clock=not keeps_clock) == ""
    run.reset(SCOPE_ALL)
    assert run.set(reset_clock=True) == ""
    ended = goal.end()
    assert (ended.status, ended.result.error_code.val) == (ABORTED, CONTROL_FAILED)
    assert "the simulation was reset" in ended.result.error_code.message
    succeed(planning.move(turn_to(0.3)))
    assert planning.positions()[TURN] == pytest.approx(0.3, abs=NEAR)


def test_a_motion_goes_on_when_the_clock_alone_is_reset(planning, run, at_the_start, turn_to):
    goal = planning.start_move(turn_to(1.0, **SLOW))
    planning.joint_moves(TURN, by=0.2)
    run.reset(SCOPE_TIME)
    succeed(goal.end())
    assert planning.positions()[TURN] == pytest.approx(1.0, abs=NEAR)


# The scene from the world


def test_the_scene_with_the_things_of_the_world_goes_round(planning):
    scene = planning.scene()
    assert {WORLD, CAN} <= {each.id for each in scene.world.collision_objects}
    assert planning.apply(scene)
    after = planning.scene().world.collision_objects
    assert {each.id for each in after} == {each.id for each in scene.world.collision_objects}


def test_objects_from_a_file_join_the_things_of_the_world(planning, tmp_path):
    path = str(tmp_path / "things.scene")
    saved = planning.call(
        "/save_geometry_to_file", SaveGeometryToFile.Request(file_path_and_name=path)
    )
    assert saved.success
    loaded = planning.call(
        "/load_geometry_from_file", LoadGeometryFromFile.Request(file_path_and_name=path)
    )
    assert loaded.success
    assert CAN in {each.id for each in planning.scene().world.collision_objects}
