"""Motion planning for robot arms, without ROS below the node `move_group`."""

from typing import TYPE_CHECKING, Any

from arm_planning.errors import MoveItErrorCode, PlanningError, SrdfError
from arm_planning.request import PlanRequest, PlanResponse
from arm_planning.scene.objects import AttachedBody, CollisionObject, PlacedShape
from arm_planning.scene.scene import PlanningScene
from arm_planning.scene.shapes import Cone, Plane, TriangleMesh
from arm_planning.trajectory import TimedTrajectory

if TYPE_CHECKING:
    from arm_planning.planner import Planner, TimedCartesianPath

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


def __getattr__(name: str) -> Any:
    # Imported on first use: a program that only reads plans and scenes needs no MuJoCo.
    if name not in ("Planner", "TimedCartesianPath"):
        raise AttributeError(f"module '{__name__}' has no attribute '{name}'")
    from arm_planning import planner

    return getattr(planner, name)
