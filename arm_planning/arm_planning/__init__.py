"""Motion planning for robot arms, without ROS below the node `move_group`."""

from typing import TYPE_CHECKING

from arm_node.public_names import on_first_use

if TYPE_CHECKING:
    from arm_planning.errors import MoveItErrorCode as MoveItErrorCode
    from arm_planning.errors import PlanningError as PlanningError
    from arm_planning.errors import SrdfError as SrdfError
    from arm_planning.planner import Planner as Planner
    from arm_planning.planner import TimedCartesianPath as TimedCartesianPath
    from arm_planning.request import PlanRequest as PlanRequest
    from arm_planning.request import PlanResponse as PlanResponse
    from arm_planning.scene.objects import AttachedBody as AttachedBody
    from arm_planning.scene.objects import CollisionObject as CollisionObject
    from arm_planning.scene.objects import PlacedShape as PlacedShape
    from arm_planning.scene.scene import PlanningScene as PlanningScene
    from arm_planning.scene.shapes import Cone as Cone
    from arm_planning.scene.shapes import Plane as Plane
    from arm_planning.scene.shapes import TriangleMesh as TriangleMesh
    from arm_planning.trajectory import TimedTrajectory as TimedTrajectory

# A program that only reads plans and scenes needs no MuJoCo.
__getattr__, __dir__ = on_first_use(__name__)
