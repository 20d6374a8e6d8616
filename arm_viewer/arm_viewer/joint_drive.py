"""By which topic the page can move a joint, as the controllers are now."""

from collections.abc import Iterable
from dataclasses import dataclass
from enum import Enum

from arm_viewer.snapshot import Controller

POSITION = "/position"


class DriveKind(Enum):
    """What a controller takes; the value is its topic below the controller's name."""

    POSITIONS = "commands"
    POSITION = "command"
    TRAJECTORY = "joint_trajectory"


KINDS = {
    "JointGroupPositionController": DriveKind.POSITIONS,
    "ForwardCommandController": DriveKind.POSITIONS,
    "JointPositionController": DriveKind.POSITION,
    "JointTrajectoryController": DriveKind.TRAJECTORY,
}
"""By the last word of a controller's type."""


@dataclass(frozen=True, slots=True)
class JointDrive:
    """An active controller that takes positions of joints.

    Attributes:
        controller: its name.
        topic: absolute name of where it takes them.
        kind: in which message.
        joints: in the message's order.
    """

    controller: str
    topic: str
    kind: DriveKind
    joints: tuple[str, ...]


def joint_drives(controllers: Iterable[Controller], namespace: str) -> tuple[JointDrive, ...]:
    """Return the drives of the robot in a namespace; each joint has one at most.

    A controller claims a joint's position command for itself, so no two active ones share it.
    """
    drives = []
    for controller in controllers:
        kind = KINDS.get(controller.type.rpartition("/")[2])
        claimed = tuple(c.removesuffix(POSITION) for c in controller.claimed)
        # One that commands velocities or efforts too would want more than a slider tells.
        if (
            kind is not None
            and controller.namespace == namespace
            and controller.state == "active"
            and claimed
            and all(c.endswith(POSITION) for c in controller.claimed)
        ):
            joints = controller.joints if set(controller.joints) == set(claimed) else claimed
            topic = f"{namespace}/{controller.name}/{kind.value}"
            drives.append(JointDrive(controller.name, topic, kind, joints))
    return tuple(drives)
