"""Motion planning for robot arms, without ROS below the node `move_group`."""

from arm_planning.errors import MoveItErrorCode, PlanningError, SrdfError
from arm_planning.planner import Planner, TimedCartesianPath
from arm_planning.request import PlanRequest, PlanResponse
from arm_planning.scene.objects import AttachedBody, CollisionObject, PlacedShape
from arm_planning.scene.scene import PlanningScene
from arm_planning.scene.shapes import Cone, Plane, TriangleMesh
from arm_planning.trajectory import TimedTrajectory

__all__ = [
    "AttachedBody",
    "CollisionObject",
    "Cone",
    "MoveItErrorCode",
    "PlacedShape",
    "PlanRequest",
    "PlanResponse",
    "Plane",
    "Planner",
    "PlanningError",
    "PlanningScene",
    "SrdfError",
    "TimedCartesianPath",
    "TimedTrajectory",
    "TriangleMesh",
]
