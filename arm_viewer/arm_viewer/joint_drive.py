"""By which topic or action the page can move a joint, as the controllers are now."""

from collections.abc import Iterable
from dataclasses import dataclass
from enum import Enum

from arm_viewer.snapshot import Controller

POSITION = "/position"


class DriveKind(Enum):
    """What a controller takes: a name below the controller's own, and its type."""

    POSITIONS = "commands", "std_msgs/msg/Float64MultiArray"
    POSITION = "command", "std_msgs/msg/Float64"
    TRAJECTORY = "joint_trajectory", "trajectory_msgs/msg/JointTrajectory"
    GRIPPER = "gripper_cmd", "control_msgs/action/GripperCommand"
    PARALLEL_GRIPPER = "gripper_cmd", "control_msgs/action/ParallelGripperCommand"


KINDS = {
    "JointGroupPositionController": DriveKind.POSITIONS,
    "ForwardCommandController": DriveKind.POSITIONS,
    "JointPositionController": DriveKind.POSITION,
    "JointTrajectoryController": DriveKind.TRAJECTORY,
    "GripperActionController": DriveKind.GRIPPER,
}
"""By the last word of a controller's type."""
PARALLEL_GRIPPER_TYPE = "parallel_gripper_action_controller/GripperActionController"
"""Has the last word of others, but takes other goals."""


@dataclass(frozen=True, slots=True)
class JointDrive:
    """An active controller that takes positions of joints.

    Attributes:
        controller: its name.
        name: absolute name of the topic or action where it takes them.
        kind: in which message.
        joints: in the message's order.
    """

    controller: str
    name: str
    kind: DriveKind
    joints: tuple[str, ...]


def joint_drives(controllers: Iterable[Controller], namespace: str) -> tuple[JointDrive, ...]:
    """Return the drives of the robot in a namespace; each joint has one at most.

    A controller claims a joint's command for itself, so no two active ones share it.
    """
    drives = []
    for controller in controllers:
        kind = _kind(controller)
        if kind is None or controller.namespace != namespace or controller.state != "active":
            continue
        joints = _joints(controller, kind)
        if joints:
            name = f"{namespace}/{controller.name}/{kind.value[0]}"
            drives.append(JointDrive(controller.name, name, kind, joints))
    return tuple(drives)


def _kind(controller: Controller) -> DriveKind | None:
    if controller.type == PARALLEL_GRIPPER_TYPE:
        return DriveKind.PARALLEL_GRIPPER
    return KINDS.get(controller.type.rpartition("/")[2])


def _joints(controller: Controller, kind: DriveKind) -> tuple[str, ...]:
    """Return the joints whose positions a controller takes, none where it wants more than that."""
    if kind in (DriveKind.GRIPPER, DriveKind.PARALLEL_GRIPPER):
        # Its joint by position or effort first, then the interfaces that limit it.
        return tuple(name.rpartition("/")[0] for name in controller.claimed[:1])
    if not all(name.endswith(POSITION) for name in controller.claimed):
        return ()
    claimed = tuple(name.removesuffix(POSITION) for name in controller.claimed)
    return controller.joints if set(controller.joints) == set(claimed) else claimed
