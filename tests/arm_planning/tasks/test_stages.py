"""The stages on the myCobot: what they find, and each reason why they find nothing."""

from dataclasses import replace
from math import pi

import numpy as np
import pytest

from arm_node.rigid_transform import RigidTransform
from arm_planning.errors import PlanningError
from arm_planning.scene.objects import CollisionObject, PlacedShape
from arm_planning.scene.shapes import Box
from arm_planning.tasks.containers import Fallbacks
from arm_planning.tasks.costs import clearance, link_motion, path_length
from arm_planning.tasks.motions import Connect, MoveRelative, MoveTo, Twist
from arm_planning.tasks.poses import ComputeIK, CurrentState, GenerateGraspPose, GeneratePlacePose
from arm_planning.tasks.scene_edits import ModifyPlanningScene
from arm_planning.tasks.solvers import CartesianPathSolver, PipelinePlanner
from arm_planning.tasks.stage import TaskSearch
from arm_planning.tasks.task import StagedTask

TURN = "link1_to_link2"
BENT = {"link2_to_link3": -0.7, "link3_to_link4": -1.0, "link4_to_link5": 0.2}
FLANGE = "link6_flange"
QUARTER = RigidTransform(rotation=(np.sqrt(0.5), 0.0, 0.0, np.sqrt(0.5)))


def box(name: str, place: tuple[float, float, float], edge: float = 0.02) -> CollisionObject:
    return CollisionObject(name, RigidTransform(place), (PlacedShape(Box((edge,) * 3)),))


def put(planner, *things: CollisionObject) -> None:
    more = {**planner.scene.objects, **{thing.id: thing for thing in things}}
    planner.scene = replace(planner.scene, objects=more)


def solved(planner, *stages, **options):
    return StagedTask("task", stages).plan(planner, **options)[0]


def grasp(**options) -> ComputeIK:
    poses = GenerateGraspPose("poses", "cylinder", monitors="now", angle_delta=pi / 2)
    offset = RigidTransform((0.0, 0.0, 0.096)).then(QUARTER)
    return ComputeIK("grasp", poses, "arm", frame=FLANGE, offset=offset, **options)


def test_a_motion_relative_to_a_frame_goes_straight_along_its_axes(planner):
    bent, on = CurrentState("bent", BENT), Twist("base_link", (0.0, -0.02, 0.03))
    found = solved(planner, bent, MoveRelative("on", "arm", on)).named("on")
    begin, end = (planner.link_pose("gripper_base", each) for each in (found.start, found.end))
    assert np.subtract(end.position, begin.position) == pytest.approx((0.0, -0.02, 0.03), abs=1e-5)
    assert end.rotation == pytest.approx(begin.rotation, abs=1e-5)


def test_a_turn_leaves_the_link_where_it_is(planner):
    turn = Twist("base_link", angular=(0.0, 0.0, -pi / 10))
    found = solved(planner, CurrentState("bent", BENT), MoveRelative("turn", "arm", turn))
    begin, end = (planner.link_pose("gripper_base", each) for each in (found.start, found.end))
    assert end.position == pytest.approx(begin.position, abs=1e-5)
    spin = end.then(begin.inverse()).rotation
    assert spin == pytest.approx((0.0, 0.0, -np.sin(pi / 20), np.cos(pi / 20)), abs=1e-5)


def test_a_motion_before_a_generator_is_planned_backwards_and_ends_there(planner):
    on = MoveRelative("on", "arm", Twist(FLANGE, (0.0, 0.0, 0.02)), link=FLANGE)
    found = solved(planner, on, CurrentState("bent", BENT))
    step = found.named("on")
    trajectory = step.trajectory
    arm = planner.model.group("arm")
    assert trajectory.positions[-1] == pytest.approx(arm.positions(found.end.positions))
    assert trajectory.times_s[0] == 0.0
    assert (np.diff(trajectory.times_s) > 0.0).all()
    chords = np.diff(trajectory.positions, axis=0) / np.diff(trajectory.times_s)[:, None]
    assert np.abs(trajectory.velocities).max() > 0.0
    # The velocities are those of the motion forwards: at the ends 0, between along the chords.
    middle = len(chords) // 2
    assert trajectory.velocities[middle] @ chords[middle] > 0.0
    begin, end = (planner.link_pose(FLANGE, scene) for scene in (step.start, step.end))
    assert begin.inverse().then(end).position == pytest.approx((0.0, 0.0, 0.02), abs=1e-5)


def test_a_blocked_motion_comes_as_far_as_it_must_or_says_why_not(planner, failure_of):
    bent = CurrentState("bent", BENT)
    at = planner.link_pose("gripper_base", replace(planner.scene, positions={**BENT}))
    x, y, z = at.position
    put(planner, box("plate", (x, y, z - 0.14)))
    down = Twist("", (0.0, 0.0, -0.2))
    lowered = solved(planner, bent, MoveRelative("down", "arm", down, min_distance_m=0.01))
    moved = planner.link_pose("gripper_base", lowered.end).position[2] - z
    assert -0.2 < moved < -0.01
    why = failure_of(bent, MoveRelative("down", "arm", down, min_distance_m=0.19))
    assert "stage 'down' has no solution" in why
    assert "plate" in why
    assert "190 mm" in why
    assert "plate" in failure_of(bent, MoveRelative("down", "arm", down))


def test_joints_move_by_offsets_and_unknown_ones_are_named(planner, failure_of):
    by = MoveRelative("by", "arm", {TURN: 0.3})
    end = solved(planner, CurrentState("now", {TURN: 0.2}), by).end
    assert end.positions[TURN] == pytest.approx(0.5, abs=1e-6)
    assert "no joint 'j9'" in failure_of(CurrentState(), MoveRelative("by", "arm", {"j9": 0.3}))


def test_a_connection_refuses_what_its_group_cannot_change(planner, failure_of):
    now, connect = CurrentState(), Connect("connect", "arm")
    closed = CurrentState("closed", {"gripper_controller": -0.3})
    assert "joint 'gripper_controller' is at 0 before and at -0.3" in failure_of(
        now, connect, closed
    )
    held = ModifyPlanningScene("hold", attach=["cylinder"], link=FLANGE)
    assert "the robot holds cylinder before and nothing after" in failure_of(
        now, held, connect, CurrentState("end")
    )


def test_a_connection_ends_exactly_where_the_next_stage_begins(planner):
    found = solved(planner, CurrentState(), Connect("connect", "arm"), CurrentState("end", BENT))
    reached = found.named("connect").end.positions
    assert reached == pytest.approx(found.named("end").start.positions, abs=1e-8)


def test_a_straight_motion_says_when_it_ends_in_another_posture(planner, failure_of):
    straight = MoveTo("go", "arm", {TURN: 2.5}, CartesianPathSolver())
    assert "stage 'go'" in failure_of(CurrentState("bent", BENT), straight)


def test_fallbacks_take_the_planner_that_goes_around(planner):
    bent = CurrentState("bent", BENT)
    half = {**dict.fromkeys(planner.model.joints, 0.0), **BENT, TURN: 0.6}
    at = planner.link_pose("gripper_base", replace(planner.scene, positions=half))
    put(planner, box("block", at.position))
    pilz = PipelinePlanner("pilz_industrial_motion_planner", "PTP")
    first = MoveTo("ptp", "arm", {TURN: 1.2}, pilz)
    both = Fallbacks("both", [first, MoveTo("around", "arm", {TURN: 1.2})])
    found = solved(planner, bent, both)
    assert [step.stage for step in found.steps] == ["bent", "around"]
    assert "block" in next(iter(first.failures))


@pytest.mark.parametrize("seed", [0, 5])
def test_states_of_a_grasp_are_free_and_repeat_by_their_seed(planner, seed):
    now = CurrentState("now")
    stages = now, Connect("connect", "arm"), grasp()
    found, again = (solved(planner, *stages, seed=seed) for _ in range(2))
    assert found.end.positions == again.end.positions
    for one, other in zip(found.steps, again.steps, strict=True):
        if one.trajectory is not None:
            assert np.array_equal(one.trajectory.positions, other.trajectory.positions)
    assert not planner.contacts("arm", found.end)
    hand = planner.link_pose(FLANGE, found.end).then(RigidTransform((0.0, 0.0, 0.096)))
    assert hand.position == pytest.approx((0.22, 0.12, 0.175), abs=1e-4)


def test_grasps_are_turned_at_each_height_the_preferred_first(planner):
    put(planner, box("cylinder", (0.2, 0.0, 0.1)))
    poses = GenerateGraspPose(
        "poses", "cylinder", monitors="now", angle_delta=pi / 2, heights_m=(0.05, 0.0)
    )
    search = TaskSearch(planner)
    (now,) = CurrentState("now").solve(search, None, None)
    search = search.after(now)
    targets = [each.target.position for each in poses.solve(search, None, None)]
    assert [z for _, _, z in targets] == pytest.approx([0.15] * 4 + [0.1] * 4)
    assert {(x, y) for x, y, _ in targets} == {(0.2, 0.0)}


def test_a_grasp_out_of_reach_or_in_a_collision_says_so(planner, failure_of):
    now, connect = CurrentState("now"), Connect("connect", "arm")
    cylinder = planner.scene.objects["cylinder"]
    put(planner, replace(cylinder, pose=RigidTransform((0.9, 0.0, 0.1))))
    why = failure_of(now, connect, grasp())
    assert "stage 'grasp' has no solution" in why
    assert "cannot reach" in why
    put(planner, cylinder, box("cage", (0.22, 0.12, 0.175), 0.1))
    assert "the state is in collision" in failure_of(now, connect, grasp())


def test_what_a_generator_lacks_is_named(planner, failure_of):
    now, connect = CurrentState("now"), Connect("connect", "arm")
    poses = GenerateGraspPose("poses", "cup", monitors="now")
    assert "no object 'cup' is in the world; there is cylinder" in failure_of(
        now, connect, ComputeIK("ik", poses, "arm")
    )
    poses = GenerateGraspPose("poses", "cylinder", monitors="later")
    assert "monitors the stage 'later'" in failure_of(now, connect, ComputeIK("ik", poses, "arm"))
    poses = GeneratePlacePose("poses", "cylinder", RigidTransform(), monitors="now")
    assert "does not hold the object 'cylinder'" in failure_of(
        now, connect, ComputeIK("ik", poses, "arm")
    )
    assert "generates no poses" in failure_of(
        now, connect, ComputeIK("ik", CurrentState("c"), "arm")
    )
    poses = GenerateGraspPose("poses", "cylinder", monitors="now", angle_delta=0.0)
    assert "angle_delta is 0 rad" in failure_of(now, connect, ComputeIK("ik", poses, "arm"))


def test_a_start_in_collision_names_what_touches(planner, failure_of):
    put(planner, box("block", planner.link_pose("link4").position))
    assert "block" in failure_of(CurrentState())
    assert "no joint 'j9'" in failure_of(CurrentState("now", {"j9": 0.0}))


def test_changes_of_the_scene_are_taken_back_when_they_are_planned_backwards(planner):
    pair = ("link6", "cylinder")
    hold = ModifyPlanningScene("hold", attach=["cylinder"], link=FLANGE, allow=[pair])
    leave = ModifyPlanningScene("leave", detach=["cylinder"], link=FLANGE, forbid=[pair])
    forwards = solved(planner, CurrentState(), hold)
    assert list(forwards.end.attached) == ["cylinder"]
    assert forwards.end.allowed.may_touch(*pair)
    backwards = solved(planner, leave, CurrentState())
    assert list(backwards.start.attached) == ["cylinder"]
    assert backwards.start.allowed.may_touch(*pair)
    assert list(backwards.end.objects) == ["cylinder"]


def test_what_cannot_be_attached_is_the_reason(planner, failure_of):
    hold = ModifyPlanningScene("hold", attach=["cup"], link=FLANGE)
    assert "'cup'" in failure_of(CurrentState(), hold)
    assert "no link 'hand'" in failure_of(
        CurrentState(), ModifyPlanningScene("hold", attach=["cylinder"], link="hand")
    )


def test_costs_measure_the_motion(planner):
    by, turn = {TURN: 0.5}, CurrentState("now", BENT)
    swept = solved(planner, turn, MoveRelative("by", "arm", by, cost=path_length))
    assert swept.cost == pytest.approx(0.5, abs=1e-6)
    moved = solved(planner, turn, MoveRelative("by", "arm", by, cost=link_motion(FLANGE)))
    x, y, _ = planner.link_pose(FLANGE, moved.start).position
    assert moved.cost == pytest.approx(0.5 * np.hypot(x, y), rel=1e-2)


def test_the_clearance_prefers_states_far_from_the_world(planner):
    cost = clearance("arm")
    found = StagedTask("task", [CurrentState("now"), Connect("c", "arm"), grasp(cost=cost)])
    (best,) = found.plan(planner)
    near = [
        1.0 / cost(replace(best.named("grasp"), end=scene), planner)
        for scene in (best.end, planner.scene)
    ]
    assert 0.0 < near[0] < near[1]
    put(planner, box("block", planner.link_pose("link4").position))
    with pytest.raises(PlanningError, match="in collision"):
        cost(replace(best.named("grasp"), end=planner.scene), planner)
