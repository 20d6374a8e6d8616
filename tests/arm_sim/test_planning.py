"""Plans of the library, around what is in its world."""

import numpy as np
import pytest
from robots import link, robot

from arm_gazebo.recording.replay import Replay
from arm_gazebo.recording.run_file import RunFile
from arm_planning.errors import MoveItErrorCode, PlanningError
from arm_sim import CallError, Simulation

BLOCK = """<mujoco model="block"><worldbody>
  <body name="block"><geom type="box" size="0.06 0.06 0.06" rgba="1 0 0 1"/></body>
</worldbody></mujoco>"""
ACROSS = {"link1_to_link2": 0.0, "link2_to_link3": -1.2}
"""The arm is bent to the side of positive x, where the block will be."""


@pytest.fixture(scope="module")
def sim():
    with Simulation("mycobot", world="empty") as sim:
        sim.run(0.2)
        yield sim


def refusal(sim: Simulation, goal) -> PlanningError:
    with pytest.raises(PlanningError) as error:
        sim.plan(goal)
    return error.value


def test_a_plan_to_a_named_state_is_followed_by_the_controller_of_its_joints(sim):
    plan = sim.plan("ready")
    assert len(plan.times_s) == len(plan.positions)
    assert sim.follow(plan).message == "Goal successfully reached!"
    assert abs(sim.joints["link3_to_link4"].position - np.pi / 2) < 0.01


def test_the_same_goal_from_the_same_state_gives_the_same_plan(sim):
    first, second = sim.plan("home"), sim.plan("home")
    assert np.array_equal(first.positions, second.positions)
    assert np.array_equal(first.times_s, second.times_s)


def test_a_recording_of_planned_motions_replays_with_equal_states(sim, tmp_path):
    with sim.record(tmp_path / "planned.run"):
        sim.follow(sim.plan("ready"))
        sim.follow(sim.plan("home"))
    result = Replay(RunFile(tmp_path / "planned.run")).run()
    assert result.difference is None
    assert result.periods > 50


def test_a_plan_made_again_from_a_snapshot_ends_in_the_same_bits(sim):
    sim.follow(sim.plan("home"))
    start, ends = sim.save(), []
    for _ in range(2):
        sim.restore(start)
        sim.follow(sim.plan("ready"))
        ends.append([(joint.position, joint.velocity) for joint in sim.joints.values()])
    assert ends[0] == ends[1]


def test_a_pose_is_in_the_world(sim):
    sim.follow(sim.plan("home"))
    sim.follow(sim.plan({"link2_to_link3": -0.6, "link3_to_link4": 0.4}))
    there = sim.pose("gripper_base")
    sim.follow(sim.plan("home"))
    sim.follow(sim.plan(there))
    assert np.abs(sim.pose("gripper_base") - there).max() < 0.01


def test_what_stands_in_the_world_is_in_the_way(sim):
    sim.follow(sim.plan("home"))
    assert sim.plan(ACROSS).times_s[-1] > 0.0
    reached = sim.plan(ACROSS)
    sim.follow(reached)
    x, y, z = sim.pose("gripper_base")[:3, 3]
    sim.follow(sim.plan("home"))
    sim.spawn(BLOCK, name="block", pose=(x, y, z))
    try:
        blocked = refusal(sim, ACROSS)
    finally:
        sim.delete("block")
    assert blocked.code is MoveItErrorCode.GOAL_IN_COLLISION
    assert "with block" in str(blocked)
    assert sim.plan(ACROSS).times_s[-1] > 0.0


def test_goals_that_are_none_end_in_a_sentence(sim):
    assert "has no state 'nope'; it has" in str(refusal(sim, "nope"))
    for joint in ("elbow", "gripper_controller"):
        said = f"group 'arm' has no joint '{joint}'; it has link1_to_link2"
        assert str(refusal(sim, {joint: -0.2})).startswith(said)
    endless = refusal(sim, {"link1_to_link2": float("nan")})
    assert str(endless) == "the constraint on joint 'link1_to_link2' is not finite"
    with pytest.raises(CallError, match="a goal is joint positions by name"):
        sim.plan(None)
    with pytest.raises(PlanningError, match="no group 'leg'; the robot has arm"):
        sim.plan("home", "leg")
    with pytest.raises(CallError, match="joint 'link1_to_link2' is 'far', not a number"):
        sim.plan({"link1_to_link2": "far"})


@pytest.mark.parametrize("value", [0, -1, float("nan"), "slow"])
@pytest.mark.parametrize(
    ("option", "what"), [("speed", "speed"), ("allowed_time_s", "time to plan in")]
)
def test_a_speed_or_a_time_that_is_no_positive_number_is_refused(sim, option, what, value):
    with pytest.raises(CallError, match=f"the {what} is {value!r}; it is a "):
        sim.plan("ready", **{option: value})


def test_speeds_above_the_limits_and_seeds_that_are_none_are_refused(sim):
    with pytest.raises(CallError, match="the speed is 2; it is a fraction above 0, and at most 1"):
        sim.plan("ready", speed=2)
    with pytest.raises(CallError, match="the seed is -1; it is a whole number from 0"):
        sim.plan("ready", seed=-1)


def test_a_robot_without_joints_has_nothing_to_move(tmp_path):
    file = tmp_path / "block.urdf"
    file.write_text(robot(link("block")))
    with Simulation(str(file)) as still:
        assert str(refusal(still, {})) == "the robot has no group to move"


def test_a_trajectory_alone_needs_joints_that_a_controller_drives(sim):
    points = {"times_s": [1.0], "positions": [[0.0]]}
    with pytest.raises(CallError, match="needs a trajectory that names its joints"):
        sim.follow(points)
    with pytest.raises(CallError, match="no active controller follows trajectories of elbow"):
        sim.follow({**points, "joints": ["elbow"]})
    with pytest.raises(CallError, match=r"follow\('arm_controller'\) lacks the trajectory"):
        sim.follow("arm_controller")


def test_a_check_says_where_the_robot_touches_nothing(sim):
    sim.follow(sim.plan("home"))
    joints = ["link2_to_link3", "gripper_controller"]
    x, y, z = sim.pose("gripper_base")[:3, 3]
    sim.spawn(BLOCK, name="block", pose=(x, y, z))
    try:
        is_free, ignores = sim.collision_check(joints), sim.collision_check(joints, ["block"])
        assert [is_free(np.array([0.0, 0.0])), ignores(np.array([0.0, 0.0]))] == [False, True]
        assert is_free(np.array([-0.8, 0.0]))
    finally:
        sim.delete("block")
