"""What services and actions that plan have in common."""

from dataclasses import dataclass, replace

import pytest
from moveit_msgs.msg import Constraints, JointConstraint, MotionPlanRequest
from planar_robot import planar_model

from arm_description.urdf.robot import Box
from arm_node.rigid_transform import RigidTransform
from arm_planning import CollisionObject, PlacedShape, PlanningScene
from arm_planning.collision.mesh_pieces import MeshPieces
from arm_planning.planners.pilz.cartesian_limits import CartesianLimits
from arm_planning.ros.planning_session import PlanningSession
from arm_planning.ros.robot_setup import PlanningSetup
from arm_planning.scene.allowed_collisions import AllowedCollisions

EMPTY = PlanningScene(
    {"shoulder": 0.0, "elbow": 0.0}, allowed=AllowedCollisions({("fore", "upper"): True})
)
SIDE = PlacedShape(Box((0.1, 0.1, 0.1)), RigidTransform())
BOX = CollisionObject("box", RigidTransform((0.6, 0.5, 0.0)), (SIDE,))


@dataclass
class Monitor:
    """Holds a scene, as the scene monitor does."""

    scene: PlanningScene = EMPTY
    problem: str = ""

    @property
    def states(self) -> "Monitor":
        return self

    def wait_for_fresh(self, *_: object) -> str:
        return self.problem

    def current(self) -> PlanningScene:
        return self.scene


@pytest.fixture
def monitor() -> Monitor:
    return Monitor()


@pytest.fixture
def session(monitor) -> PlanningSession:
    setup = PlanningSetup(
        planar_model(), EMPTY, "", MeshPieces(), CartesianLimits(), 0, in_world=None
    )
    return PlanningSession(setup, monitor)


def test_what_came_while_a_plan_was_made_blocks_it(session, monitor):
    with session.planner() as planner:
        trajectory = planner.move("arm", {"shoulder": 1.5, "elbow": 0.0})
    monitor.scene = replace(EMPTY, objects={"box": BOX})
    assert "box" in session.watch(trajectory, EMPTY)(0.0)


def test_a_scene_that_stays_as_it_was_blocks_nothing(session, monitor):
    with session.planner() as planner:
        trajectory = planner.move("arm", {"shoulder": 1.5, "elbow": 0.0})
    assert session.watch(trajectory, monitor.scene)(0.0) == ""


def test_a_plan_from_an_old_state_says_so(session, monitor):
    monitor.problem = "joint_states stopped 3.0 s ago"
    goal = Constraints(joint_constraints=[JointConstraint(joint_name="shoulder", position=1.0)])
    response = session.plan(MotionPlanRequest(group_name="arm", goal_constraints=[goal]))
    assert response.trajectory is not None
    assert response.message == (
        "planning starts from the last known state: joint_states stopped 3.0 s ago"
    )
