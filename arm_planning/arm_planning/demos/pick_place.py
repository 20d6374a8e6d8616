"""A cylinder is picked up and put down elsewhere: `pick_place_demo`, and `mtc_node`."""

from dataclasses import dataclass

from arm_node.rigid_transform import RigidTransform
from arm_planning.robot.model import PlanningModel
from arm_planning.scene.objects import CollisionObject, PlacedShape
from arm_planning.scene.shapes import Cylinder
from arm_planning.tasks.containers import SerialContainer
from arm_planning.tasks.motions import Connect, MoveRelative, MoveTo, Twist
from arm_planning.tasks.poses import ComputeIK, CurrentState, GenerateGraspPose, GeneratePlacePose
from arm_planning.tasks.scene_edits import ModifyPlanningScene
from arm_planning.tasks.task import StagedTask

OBJECT, FLANGE = "object", "link6_flange"
HEIGHT_M = 0.15
"""Of the cylinder's centre above base_link, which is 25 mm above the floor."""
CYLINDER = CollisionObject(
    OBJECT, RigidTransform((0.22, 0.12, HEIGHT_M)), (PlacedShape(Cylinder(0.015, 0.35)),)
)
PLACE = RigidTransform((-0.183, -0.14, HEIGHT_M))
QUARTER_TURN = (0.5**0.5, 0.0, 0.0, 0.5**0.5)
GRASP_FRAME = RigidTransform((0.0, 0.0, 0.096), QUARTER_TURN)
"""Between the pads of the gripper, its z axis up, in the frame of the flange."""
BELOW_TOP_M = (0.05, 0.08, 0.03, 0.11)
"""Where a thing can be gripped if not in its middle: the arm is in its own way near the ground."""
ANGLE_DELTA = 0.1309
"""Angle between two grasps, rad."""


@dataclass(frozen=True, slots=True)
class Picked:
    """What is picked up, and where it is put down.

    Attributes:
        name: id of the object.
        place: its pose there, in the planning frame.
        support: id of the object on which it stands; "" if it is not in the scene.
        heights_m: where it may be gripped, above its middle, the preferred first.
    """

    name: str = OBJECT
    place: RigidTransform = PLACE
    support: str = ""
    heights_m: tuple[float, ...] = (0.0,)

    def touching(self) -> list[tuple[str, str]]:
        """Return the pair of the object and its support."""
        return [(self.name, self.support)] if self.support else []


def heights_near_top(length_m: float) -> tuple[float, ...]:
    """Return where a thing of some length may be gripped above its middle, in m."""
    half = 0.5 * length_m
    return tuple(half - below for below in BELOW_TOP_M if below < half)


def pick_place(model: PlanningModel, picked: Picked = Picked()) -> StagedTask:
    """Return the task."""
    return StagedTask(
        "pick_place_demo",
        [
            CurrentState(),
            MoveTo("open gripper", "gripper", "open"),
            Connect("move to pick", "arm"),
            pick(model, picked),
            Connect("move to place", "arm"),
            place(model, picked),
            MoveTo("move home", "arm", "home"),
        ],
    )


def pick(model: PlanningModel, picked: Picked) -> SerialContainer:
    """Return the stages around the grasp; those before it are planned backwards from it."""
    name, touching = picked.name, picked.touching()
    grasps = GenerateGraspPose(
        "generate grasp pose",
        name,
        monitors="open gripper",
        angle_delta=ANGLE_DELTA,
        heights_m=picked.heights_m,
    )
    forwards, up = Twist(FLANGE, (0.0, 0.0, 0.1)), Twist("", (0.0, 0.0, 0.1))
    return SerialContainer(
        "pick object",
        [
            MoveRelative("approach object", "arm", forwards, link=FLANGE, min_distance_m=0.03),
            ComputeIK("grasp pose IK", grasps, "arm", frame=FLANGE, offset=GRASP_FRAME),
            ModifyPlanningScene("allow collision (gripper,object)", allow=fingers(model, name)),
            MoveTo("close gripper", "gripper", "closed"),
            ModifyPlanningScene("allow collision (object,support_surface)", allow=touching),
            ModifyPlanningScene("attach object", attach=[name], link=FLANGE),
            MoveRelative("lift object", "arm", up, min_distance_m=0.02),
            ModifyPlanningScene("forbid collision (object,support_surface)", forbid=touching),
        ],
    )


def place(model: PlanningModel, picked: Picked) -> SerialContainer:
    """Return the stages around the place."""
    name, touching = picked.name, picked.touching()
    places = GeneratePlacePose(
        "generate place pose", name, picked.place, monitors="pick object", angle_delta=ANGLE_DELTA
    )
    down, back = Twist("", (0.0, 0.0, -0.1)), Twist(FLANGE, (0.0, 0.0, -0.1))
    return SerialContainer(
        "place object",
        [
            ModifyPlanningScene("allow collision (object,support_surface)", allow=touching),
            MoveRelative("lower object", "arm", down, min_distance_m=0.02),
            ComputeIK("place pose IK", places, "arm", frame=name),
            MoveTo("open gripper", "gripper", "open"),
            ModifyPlanningScene("forbid collision (gripper,object)", forbid=fingers(model, name)),
            ModifyPlanningScene("detach object", detach=[name], link=FLANGE),
            MoveRelative("retreat after place", "arm", back, link=FLANGE, min_distance_m=0.03),
        ],
    )


def fingers(model: PlanningModel, name: str) -> list[tuple[str, str]]:
    """Return the pairs of a finger's link and the object."""
    return [(link, name) for link in model.group("gripper").links]
