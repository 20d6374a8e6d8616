"""A jog, period by period, without ROS."""

from collections.abc import Sequence
from functools import cache
from math import inf, nan

import numpy as np
import pytest
from planning_models import model_of, mycobot, neighbours
from robots import joint, link, robot

from arm_description import forward_kinematics
from arm_node.rigid_transform import RigidTransform
from arm_planning.collision.model import CollisionModel
from arm_planning.errors import PlanningError
from arm_planning.robot.model import PlanningModel
from arm_planning.scene.objects import CollisionObject, PlacedShape
from arm_planning.scene.scene import PlanningScene
from arm_planning.scene.shapes import Box
from arm_planning.servo.commands import JogCommand, JointSpeeds, TipTarget, TipTwist
from arm_planning.servo.jog import Jog, JogStep
from arm_planning.servo.settings import SPEED_UNITS, ServoSettings
from arm_planning.servo.status import StatusCode

PERIOD_S = 0.01
BALL = "<collision><geometry><sphere radius='0.1'/></geometry></collision>"
LIMIT = {"limits": (-3.0, 3.0), "velocity": 2.0}
SLIDER = robot(
    link("base"),
    link("sledge", BALL),
    joint("slide", "base", "sledge", **LIMIT, kind="prismatic", axis="1 0 0"),
)
BENT = (0.0, -0.5, 1.57, 0.6, 0.3, 0.0)
"""The myCobot far from limits, singularities and itself."""


@cache
def cobot() -> PlanningModel:
    return mycobot()


class Driven:
    """A robot that is where the jog has commanded it."""

    def __init__(self, model: PlanningModel, *start: float, scene=None, **settings) -> None:
        self.model = model
        self.jog = Jog(model, ServoSettings(**settings))
        self.scene = scene or PlanningScene(dict.fromkeys(model.joints, 0.0))
        joints = self.jog.group.joints
        self.positions = {
            **dict.fromkeys(model.joints, 0.0),
            **dict(zip(joints, start, strict=False)),
        }

    @property
    def q(self) -> np.ndarray:
        return self.jog.group.positions(self.positions)

    def step(self, command: JogCommand | None) -> JogStep:
        step = self.jog.step(command, self.scene, self.positions, PERIOD_S)
        joints = self.jog.group.joints
        self.positions.update(zip(joints, step.positions.tolist(), strict=True))
        return step

    def run(self, command: JogCommand | None, seconds: float) -> list[JogStep]:
        return [self.step(command) for _ in range(round(seconds / PERIOD_S))]

    @property
    def tip(self) -> np.ndarray:
        return forward_kinematics(self.model.robot, self.positions)[self.jog.group.tip]


def slider(*start: float, wall_at: float = inf, **settings) -> Driven:
    wall = CollisionObject(
        "wall", RigidTransform((wall_at + 0.1, 0.0, 0.0)), (PlacedShape(Box((0.2, 1.0, 1.0))),)
    )
    scene = PlanningScene({"slide": 0.0}, {} if wall_at == inf else {"wall": wall})
    return Driven(model_of(SLIDER, arm=(("slide",), "sledge")), *start, scene=scene, **settings)


def arm(*start: float, **settings) -> Driven:
    model = cobot()
    scene = PlanningScene(dict.fromkeys(model.joints, 0.0), allowed=neighbours(model))
    settings = {"check_collisions": False, **settings}
    return Driven(model, *start, scene=scene, **settings)


def codes(steps: Sequence[JogStep]) -> set[StatusCode]:
    return {step.status.code for step in steps}


def test_the_first_step_starts_from_the_present_state_at_its_acceleration():
    driven = slider(0.4)
    first = driven.step(JointSpeeds({"slide": 1.0}))
    assert first.positions == pytest.approx([0.4 + 3.0 * PERIOD_S**2])
    assert first.is_moving


def test_without_commands_it_comes_to_rest_and_then_commands_nothing():
    driven = slider(0.0)
    driven.run(JointSpeeds({"slide": 1.0}), 0.5)
    steps = driven.run(None, 0.5)
    speeds = [0.5, *(float(step.speeds[0]) for step in steps)]
    assert max(abs(np.diff(speeds))) <= 3.0 * PERIOD_S + 1e-9
    moving = [step for step in steps if step.is_moving]
    assert moving[-1].speeds[0] == 0.0
    assert 10 < len(moving) < 25
    assert not steps[-1].is_moving


def test_speeds_are_factors_or_in_units():
    factors, units = slider(0.0), slider(0.0, command_in_type=SPEED_UNITS)
    assert factors.run(JointSpeeds({"slide": 0.6}), 1.0)[-1].speeds == pytest.approx([0.3])
    assert units.run(JointSpeeds({"slide": 0.6}), 1.0)[-1].speeds == pytest.approx([0.6])


def test_it_slows_down_before_a_wall_and_stops_there_without_touching_it():
    driven = slider(0.0, wall_at=0.5)
    steps = driven.run(JointSpeeds({"slide": 1.0}), 3.0)
    assert codes(steps) >= {StatusCode.NO_WARNING, StatusCode.DECELERATE_FOR_COLLISION}
    assert "sledge with wall" in steps[-1].status.message
    gap = 0.5 - 0.1 - driven.q[0]
    assert 0.0 < gap < 0.02
    assert max(abs(step.speeds[0]) for step in steps) == pytest.approx(0.5)


@pytest.mark.parametrize("start", [0.395, 0.4005, 0.45])
def test_from_a_wall_the_way_out_is_open_at_full_speed(start):
    driven = slider(start, wall_at=0.5)
    steps = driven.run(JointSpeeds({"slide": -1.0}), 0.5)
    assert codes(steps) == {StatusCode.NO_WARNING}
    assert steps[-1].speeds == pytest.approx([-0.5])


def test_in_contact_the_way_in_is_closed_and_says_so():
    driven = slider(0.41, wall_at=0.5)
    step = driven.step(JointSpeeds({"slide": 1.0}))
    assert step.status.code is StatusCode.HALT_FOR_COLLISION
    assert driven.q == pytest.approx([0.41])


def test_a_wall_that_comes_into_the_scene_counts_at_once():
    driven = slider(0.0)
    driven.run(JointSpeeds({"slide": 1.0}), 0.2)
    driven.scene = slider(0.0, wall_at=driven.q[0] + 0.2).scene
    driven.run(JointSpeeds({"slide": 1.0}), 1.0)
    wall = driven.scene.objects["wall"].pose.position[0] - 0.1
    assert driven.q[0] + 0.1 < wall


def test_a_twist_moves_the_tip_straight_and_keeps_its_orientation():
    driven = arm(*BENT)
    before = driven.tip
    driven.run(TipTwist((0.0, 0.0, 0.25), (0.0, 0.0, 0.0)), 0.4)
    moved = driven.tip[:3, 3] - before[:3, 3]
    assert 0.01 < moved[2] < 0.03
    assert np.abs(moved[:2]).max() < 0.002
    assert np.abs(driven.tip[:3, :3] - before[:3, :3]).max() < 0.01


def test_a_twist_is_on_the_axes_of_its_frame():
    driven = arm(*BENT)
    before = driven.tip
    driven.run(TipTwist((0.0, 0.0, -0.25), (0.0, 0.0, 0.0), "gripper_base"), 0.3)
    moved = before[:3, :3].T @ (driven.tip[:3, 3] - before[:3, 3])
    assert moved[2] < -0.01
    assert np.abs(moved[:2]).max() < 0.002


def test_it_stops_before_a_singularity_and_comes_back():
    driven = arm(*BENT)
    outwards = before = driven.tip[:3, 3] / np.linalg.norm(driven.tip[:3, 3])
    steps = driven.run(TipTwist(tuple(0.5 * outwards), (0.0, 0.0, 0.0)), 3.0)
    assert codes(steps) >= {
        StatusCode.DECELERATE_FOR_APPROACHING_SINGULARITY,
        StatusCode.HALT_FOR_SINGULARITY,
    }
    assert np.abs(steps[-1].speeds).max() < 0.05
    before = driven.tip[:3, 3]
    steps = driven.run(TipTwist(tuple(-0.5 * outwards), (0.0, 0.0, 0.0)), 1.0)
    assert StatusCode.HALT_FOR_SINGULARITY not in codes(steps)
    assert float((driven.tip[:3, 3] - before) @ outwards) < -0.05


def test_a_stretched_arm_can_be_pulled_back():
    driven = arm(*[0.0] * 6)
    before = driven.tip[:3, 3]
    driven.run(TipTwist((0.0, 0.0, -1.0), (0.0, 0.0, 0.0)), 2.0)
    moved = driven.tip[:3, 3] - before
    assert moved[2] < -0.05
    assert np.abs(moved[:2]).max() < 0.01


def test_four_joints_follow_the_position_first():
    arm4 = robot(
        *(link(name) for name in ("base", "a", "b", "c", "d")),
        joint("yaw", "base", "a", **LIMIT, kind="revolute", axis="0 0 1"),
        joint("shoulder", "a", "b", **LIMIT, kind="revolute", axis="0 1 0", xyz="0 0 0.1"),
        joint("elbow", "b", "c", **LIMIT, kind="revolute", axis="0 1 0", xyz="0.3 0 0"),
        joint("wrist", "c", "d", **LIMIT, kind="revolute", axis="0 1 0", xyz="0.3 0 0"),
    )
    model = model_of(arm4, arm=(("yaw", "shoulder", "elbow", "wrist"), "d"))
    driven = Driven(model, 0.3, -0.8, 1.4, 0.3)
    before = driven.tip[:3, 3]
    driven.run(TipTwist((0.0, 0.2, 0.2), (0.0, 0.0, 0.0)), 1.0)
    moved = driven.tip[:3, 3] - before
    assert moved[1] > 0.05
    assert moved == pytest.approx([0.0, moved[1], moved[1]], abs=0.01)


def test_a_target_pose_is_reached_and_kept():
    driven = arm(*BENT)
    start = driven.tip[:3, 3]
    target = RigidTransform((0.0, 0.01, -0.03), (0.0, 0.0, np.sin(0.1), np.cos(0.1)))
    wanted = driven.tip @ np.array(target.matrix())
    fixed = TipTarget(
        RigidTransform(tuple(wanted[:3, 3]), _quaternion(wanted[:3, :3])), "base_link"
    )
    driven.run(fixed, 3.0)
    assert np.linalg.norm(wanted[:3, 3] - start) > 0.02
    assert driven.tip[:3, 3] == pytest.approx(wanted[:3, 3], abs=0.0015)
    assert driven.tip[:3, :3] == pytest.approx(wanted[:3, :3], abs=0.015)
    assert not driven.step(fixed).is_moving


def _quaternion(rotation: np.ndarray) -> tuple[float, float, float, float]:
    from scipy.spatial.transform import Rotation

    x, y, z, w = Rotation.from_matrix(rotation).as_quat().tolist()
    return (x, y, z, w)


def test_no_sequence_of_commands_leads_into_a_collision_or_over_a_limit():
    driven = arm(*BENT, check_collisions=True)
    group = driven.jog.group
    judge = CollisionModel(driven.model, driven.scene, group.name)
    assert judge.is_free(driven.q)
    random = np.random.default_rng(3)
    halted = 0
    for _ in range(25):
        twist = random.uniform(-1.0, 1.0, 6)
        command = (
            TipTwist(tuple(twist[:3]), tuple(twist[3:]))
            if random.uniform() < 0.5
            else JointSpeeds(dict(zip(group.joints, (4.0 * twist).tolist(), strict=True)))
        )
        for step in driven.run(command, 0.5):
            halted += step.status.code is not StatusCode.NO_WARNING
            assert judge.is_free(step.positions), judge.contacts(step.positions)
            assert (step.positions >= group.lower).all()
            assert (step.positions <= group.upper).all()
            assert (np.abs(step.speeds) <= [each.velocity + 1e-9 for each in group.limits]).all()
    assert halted > 100


def test_commands_that_cannot_be_used_end_in_a_sentence():
    driven = arm(*BENT)
    with pytest.raises(PlanningError, match="Unknown frame: gripper_bas; did you mean"):
        driven.step(TipTwist((0.1, 0.0, 0.0), (0.0, 0.0, 0.0), "gripper_bas"))
    with pytest.raises(PlanningError, match="the twist is not finite"):
        TipTwist((nan, 0.0, 0.0), (0.0, 0.0, 0.0))
    joints = driven.jog.group.joints
    with pytest.raises(PlanningError, match="no joint 'elbow'; "):
        JointSpeeds.of(["elbow"], [1.0], joints)
    with pytest.raises(PlanningError, match="the velocity of 'link1_to_link2' is inf"):
        JointSpeeds.of(["link1_to_link2"], [inf], joints)
    with pytest.raises(PlanningError, match="2 joint names have 1 velocities"):
        JointSpeeds.of(list(joints[:2]), [1.0], joints)
    assert driven.q == pytest.approx(BENT)


def test_a_group_without_a_tip_is_jogged_by_joints_only():
    driven = Driven(model_of(SLIDER, fingers=(("slide",), "")), 0.0, group="fingers")
    assert driven.run(JointSpeeds({"slide": 1.0}), 1.0)[-1].speeds == pytest.approx([0.5])
    with pytest.raises(PlanningError, match="group 'fingers' is not a chain"):
        driven.step(TipTwist((1.0, 0.0, 0.0), (0.0, 0.0, 0.0)))
    assert Jog(model_of(SLIDER, fingers=(("slide",), "")), ServoSettings()).group.name == "fingers"
