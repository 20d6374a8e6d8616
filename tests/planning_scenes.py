"""A small robot for tests of planning scenes, and what is done in them.

Its hand is at (1.5, 0, 1) as long as its joints are at POSITIONS, turned by nothing.
"""

from typing import Any

from robots import joint, link, robot

from arm_description import parse_urdf
from arm_description.urdf.robot import Box
from arm_node.rigid_transform import RigidTransform
from arm_planning.robot.build import planning_model
from arm_planning.robot.srdf import parse_srdf
from arm_planning.scene.frames import LinkPoses
from arm_planning.scene.object_changes import ObjectChange, Operation
from arm_planning.scene.objects import PlacedShape
from arm_planning.scene.scene import PlanningScene

ROBOT = parse_urdf(
    robot(
        *(link(name) for name in ("base", "arm", "hand", "finger")),
        joint("turn", "base", "arm", xyz="0 0 1", axis="0 0 1"),
        joint("slide", "arm", "hand", xyz="1 0 0", axis="1 0 0", kind="prismatic"),
        joint("follow", "hand", "finger", "<mimic joint='slide' multiplier='-1'/>", axis="0 0 1"),
    )
)
VIRTUAL = "<virtual_joint name='v' type='planar' parent_frame='odom' child_link='base'/>"
MODEL = planning_model(
    ROBOT, parse_srdf(f"<robot name='r'>{VIRTUAL}</robot>", ROBOT), warn=lambda _: None
)
POSITIONS = {"turn": 0.0, "slide": 0.5}
SCENE = PlanningScene(POSITIONS)
LINKS = LinkPoses(MODEL, POSITIONS)
CUBE = PlacedShape(Box((0.1, 0.1, 0.1)))


def at(x: float = 0.0, y: float = 0.0, z: float = 0.0) -> RigidTransform:
    """A pose that is not turned."""
    return RigidTransform((x, y, z))


def add(name: str, pose: RigidTransform = RigidTransform(), **more: Any) -> ObjectChange:
    """Add a cube, or other shapes."""
    return ObjectChange(Operation.ADD, name, pose=pose, **{"shapes": (CUBE,), **more})
