"""The myCobot with its configuration, and a cylinder within its reach."""

from collections.abc import Callable
from dataclasses import replace
from math import cos, sin

import pytest

from arm_description import expand_xacro
from arm_description.resources import ResourceFinder
from arm_description.urdf.robot import Cylinder
from arm_node.rigid_transform import RigidTransform
from arm_planning.errors import PlanningError
from arm_planning.planner import Planner
from arm_planning.scene.objects import CollisionObject, PlacedShape
from arm_planning.tasks.task import StagedTask

URDF = "package://mycobot_description/urdf/robots/mycobot_280.urdf.xacro"
TURN = 34 * 0.1309
SRDF = "package://mycobot_moveit_config/config/mycobot_280/mycobot_280.srdf"


@pytest.fixture(scope="package")
def made() -> Planner:
    finder = ResourceFinder()
    urdf, srdf = expand_xacro(finder.find(URDF)), finder.find(SRDF).read_text()
    return Planner.of_urdf(urdf, srdf, resources=finder)


@pytest.fixture
def planner(made: Planner) -> Planner:
    """All joints at 0, and a cylinder beside the robot."""
    # Its x axis is where the hand can come from.
    turn = (0.0, 0.0, sin(TURN / 2.0), cos(TURN / 2.0))
    place = RigidTransform((0.22, 0.12, 0.175), turn)
    cylinder = CollisionObject("cylinder", place, (PlacedShape(Cylinder(0.0125, 0.35)),))
    positions = dict.fromkeys(made.model.joints, 0.0)
    made.scene = replace(
        made.scene, positions=positions, objects={"cylinder": cylinder}, attached={}
    )
    return made


@pytest.fixture
def failure_of(planner: Planner) -> Callable[..., str]:
    """Plans a task that has no solution; returns why."""

    def run(*stages) -> str:
        with pytest.raises(PlanningError) as caught:
            StagedTask("task", stages).plan(planner)
        return str(caught.value)

    return run
