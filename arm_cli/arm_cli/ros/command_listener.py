"""Listens to the set-points of a controller."""

from collections.abc import Iterable, Mapping
from typing import Any

from arm_cli.doctor.observation import CommandTopic, ControlState, LoadedController
from arm_cli.interfaces.index import InterfaceIndex, load_class
from arm_cli.ros.qos import MEASURING
from arm_cli.ros.session import Session
from arm_cli.ros.simulation_listener import ClockListener

COMMAND_TYPES = (
    "std_msgs/msg/Float64",
    "std_msgs/msg/Float64MultiArray",
    "trajectory_msgs/msg/JointTrajectory",
)
COMMAND_NAMES = ("command", "commands", "joint_trajectory", "reference")


def command_controllers(
    topics: Mapping[str, list[str]], managers: Iterable[ControlState]
) -> dict[str, LoadedController | None]:
    """Return the topics of set-points, with the controller that each belongs to, None for nobody's.

    A controller has them below its own name: /position_controller/commands.
    """
    loaded = {
        f"{manager.manager.rpartition('/')[0]}/{controller.name}": controller
        for manager in managers
        for controller in manager.controllers
    }
    return {
        name: loaded.get(name.rpartition("/")[0])
        for name, types in topics.items()
        if name.rpartition("/")[2] in COMMAND_NAMES
        and len(types) == 1
        and types[0] in COMMAND_TYPES
    }


class CommandListener:
    """Counts the messages of one topic, and compares the last one's stamp with the clock.

    Attributes:
        topic: its absolute name.
    """

    def __init__(
        self,
        session: Session,
        topic: str,
        type_name: str,
        controller: LoadedController | None,
        clock: ClockListener,
    ) -> None:
        """Subscribe with the session's node."""
        self.topic = topic
        self._controller = controller
        self._clock = clock
        self._received = 0
        self._ahead_s: float | None = None
        self._lasting_s = 0.0
        message_class = load_class(InterfaceIndex().find(type_name, ("msg",)))
        session.node.create_subscription(message_class, topic, self._take, MEASURING)

    def report(self, publishers: tuple[str, ...], listeners: tuple[str, ...]) -> CommandTopic:
        """Return what came, with who is at both ends."""
        return CommandTopic(
            self.topic,
            publishers,
            listeners,
            controller=self._controller.name if self._controller else "",
            state=self._controller.state if self._controller else "",
            received=self._received,
            ahead_s=self._ahead_s,
            lasting_s=self._lasting_s,
        )

    def _take(self, message: Any) -> None:
        self._received += 1
        header = getattr(message, "header", None)
        stamp_s = header.stamp.sec + header.stamp.nanosec * 1e-9 if header else 0.0
        # Stamp 0 means now, whenever that is.
        self._ahead_s = stamp_s - self._clock.now_s if stamp_s and self._clock.has_begun else None
        times = [p.time_from_start for p in getattr(message, "points", ())]
        self._lasting_s = max((t.sec + t.nanosec * 1e-9 for t in times), default=0.0)
