"""The planner on an arm in space, with the suite's collision check and inverse kinematics."""

import math

import numpy as np
import pytest
from planar_arm import dense
from robots import joint, link, robot
from scipy.spatial.transform import Rotation

from arm_description.urdf.parser import parse_urdf
from arm_description.urdf.robot import Box, Sphere
from arm_node.rigid_transform import RigidTransform
from arm_planning.collision.model import CollisionModel
from arm_planning.collision.motion_proof import MotionProof
from arm_planning.constraints.constraints import (
    MotionConstraints,
    OrientationConstraint,
    PositionConstraint,
)
from arm_planning.constraints.evaluation import ConstraintEvaluator
from arm_planning.errors import MoveItErrorCode, PlanningError
from arm_planning.kinematics.group_kinematics import GroupKinematics
from arm_planning.planners.goals import GoalSampler
from arm_planning.planners.problem import PlanningProblem
from arm_planning.planners.search import RrtConnectPlanner
from arm_planning.robot.build import planning_model
from arm_planning.robot.srdf import parse_srdf
from arm_planning.scene.allowed_collisions import AllowedCollisions
from arm_planning.scene.objects import CollisionObject, PlacedShape
from arm_planning.scene.scene import PlanningScene

AXES = {"z": "0 0 1", "y": "0 1 0", "x": "1 0 0"}
LENGTHS_M = (0.15, 0.2, 0.25, 0.25, 0.15, 0.12)
START = np.array([-0.9, 0.6, 0.9, 0.0, 0.6, 0.0])


def capsule(name: str) -> str:
    shape = "<geometry><capsule radius='0.03' length='0.06'/></geometry>"
    return link(name, f"<collision><origin xyz='0 0 0.05'/>{shape}</collision>")


def arm() -> tuple[str, str]:
    links = [capsule(f"l{n}") for n in range(7)]
    joints = [
        joint(f"j{n}", f"l{n}", f"l{n + 1}", axis=AXES[axis], xyz=f"0 0 {LENGTHS_M[n]}")
        for n, axis in enumerate("zyyxyx")
    ]
    srdf = "<robot name='r'><group name='arm'><chain base_link='l0' tip_link='l6'/></group></robot>"
    return robot(*links, *joints), srdf


class Cell:
    """The arm beside a post, as planners see it."""

    def __init__(self) -> None:
        urdf, srdf = arm()
        description = parse_urdf(urdf)
        self.model = planning_model(description, parse_srdf(srdf, description), warn=lambda _: None)
        self.group = self.model.group("arm")
        post = CollisionObject(
            "post", RigidTransform((0.45, 0.0, 0.3)), (PlacedShape(Box((0.1, 0.1, 0.6))),)
        )
        neighbours = {(f"l{n}", f"l{n + 1}"): True for n in range(6)}
        scene = PlanningScene(
            dict.fromkeys(self.group.joints, 0.0),
            objects={"post": post},
            allowed=AllowedCollisions(pairs=neighbours),
        )
        self.collisions = CollisionModel(self.model, scene, "arm")
        proof = MotionProof(self.collisions)
        self.is_free, self.contacts = self.collisions.is_free, self.collisions.contacts
        self.free_count = self.collisions.free_count
        self.is_free_edge, self.prove = proof.is_free_edge, proof.prove

    def problem(
        self, goal: MotionConstraints, path: MotionConstraints = MotionConstraints()
    ) -> PlanningProblem:
        pose = self.collisions.link_pose
        goals = GoalSampler(
            (goal,),
            path,
            self.model,
            self.group,
            {},
            pose,
            GroupKinematics(self.model, "arm"),
            self,
            START,
        )
        way = ConstraintEvaluator(path, self.model, self.group, {}, pose) if path else None
        return PlanningProblem(self.group, START, goals, self, way)


@pytest.fixture(scope="module")
def cell() -> Cell:
    return Cell()


def position(*xyz: float) -> PositionConstraint:
    return PositionConstraint(
        "l6", (0.0, 0.0, 0.0), (PlacedShape(Sphere(1e-4), RigidTransform(xyz)),)
    )


def mirrored(cell: Cell) -> tuple[float, float, float]:
    x, y, z = cell.collisions.link_pose(START, "l6")[:3, 3].tolist()
    return x, -y, z


def test_a_pose_beyond_a_post_is_reached_on_a_way_that_is_proved(cell):
    target = mirrored(cell)
    path = RrtConnectPlanner().plan(cell.problem(MotionConstraints(positions=(position(*target),))))
    assert cell.prove(path) is None
    assert cell.collisions.link_pose(path[-1], "l6")[:3, 3] == pytest.approx(target, abs=2e-4)


def test_the_tool_stays_level_on_the_way_around(cell):
    pose = cell.collisions.link_pose(START, "l6")
    axis = pose[:3, 2]
    level = MotionConstraints(
        orientations=(OrientationConstraint("l6", _quaternion(pose[:3, :3]), (0.3, 0.3, math.pi)),)
    )
    goal = MotionConstraints(positions=(position(*mirrored(cell)),))
    problem = cell.problem(goal, level)
    path = RrtConnectPlanner().plan(problem)
    assert problem.path is not None
    assert all(map(problem.path.satisfied, dense(path)))
    assert cell.prove(path) is None
    assert axis @ cell.collisions.link_pose(path[-1], "l6")[:3, 2] > math.cos(0.45)


def test_a_goal_inside_the_post_says_what_it_touches(cell):
    problem = cell.problem(MotionConstraints(positions=(position(0.45, 0.0, 0.3),)))
    with pytest.raises(
        PlanningError, match=r"goal is in collision: l\d with post, \d+ mm deep"
    ) as e:
        RrtConnectPlanner().plan(problem)
    assert e.value.code == MoveItErrorCode.GOAL_IN_COLLISION


def test_a_goal_too_far_away_says_how_near_it_gets(cell):
    problem = cell.problem(MotionConstraints(positions=(position(3.0, 0.0, 0.3),)))
    with pytest.raises(PlanningError, match="goal is out of reach: ") as raised:
        RrtConnectPlanner().plan(problem)
    assert raised.value.code == MoveItErrorCode.NO_IK_SOLUTION


def _quaternion(rotation: np.ndarray) -> tuple[float, float, float, float]:
    x, y, z, w = Rotation.from_matrix(rotation).as_quat().tolist()
    return x, y, z, w
