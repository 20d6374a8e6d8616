"""The node plan_around_objects: puts a box into the planning scene, and moves around it."""

from geometry_msgs.msg import Pose, PoseStamped
from moveit_msgs.msg import CollisionObject
from rclpy.node import Node
from shape_msgs.msg import SolidPrimitive

from arm_controller.ros_moveit import MoveGroupInterface, MoveItError
from arm_controller.ros_node import run

FRAME = "world"
SIZE_M, PLACE_M = (0.2, 0.05, 0.5), (0.25, 0.0, 0.25)


class PlanAroundObjects(Node):
    """Plans a motion of the arm around a box, and executes it."""

    def __init__(self) -> None:
        super().__init__("plan_around_objects")
        self._arm = MoveGroupInterface(self, "arm", "gripper_base")

    def move(self) -> None:
        """Add the box, plan and move.

        Raises:
            MoveItError: there is no plan, or the arm did not get there.
        """
        arm, log = self._arm, self.get_logger()
        arm.connect()
        log.info(f"Planning frame: {FRAME}")
        box = the_box()
        arm.apply(box)
        log.info(f"Created collision object: {box.id}")
        log.info("Box dimensions: {:.2f} x {:.2f} x {:.2f}".format(*SIZE_M))
        log.info("Box position: ({:.2f}, {:.2f}, {:.2f})".format(*PLACE_M))
        target = PoseStamped()
        target.header.frame_id = "base_link"
        target.pose = pose((0.128, -0.266, 0.111), (0.635, -0.268, 0.694, 0.206))
        try:
            plan = arm.plan(target)
        except MoveItError:
            log.error("Planning failed!")
            raise
        arm.execute(plan)


def the_box() -> CollisionObject:
    """Return the message that adds the box."""
    box = CollisionObject(id="box1", operation=CollisionObject.ADD)
    box.header.frame_id = FRAME
    box.primitives = [SolidPrimitive(type=SolidPrimitive.BOX, dimensions=SIZE_M)]
    box.primitive_poses = [pose(PLACE_M, (0.0, 0.0, 0.0, 1.0))]
    return box


def pose(position: tuple[float, ...], orientation: tuple[float, ...]) -> Pose:
    """Return a pose; the orientation is scaled to a unit quaternion."""
    message = Pose()
    place, turn = message.position, message.orientation
    place.x, place.y, place.z = position
    norm = sum(number**2 for number in orientation) ** 0.5
    turn.x, turn.y, turn.z, turn.w = (number / norm for number in orientation)
    return message


def main() -> int:
    """Move once; return 1 if that failed."""
    return run(PlanAroundObjects, PlanAroundObjects.move)
