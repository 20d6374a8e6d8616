"""The conversation of publisher_terminal: ask for a pose, publish it, say what is wrong with it."""

from collections.abc import Callable, Sequence

from arm_controller.command_line import parse_pose_line, prompt
from arm_controller.errors import CommandLineError, DeliveryError, PoseError
from arm_controller.pose import JointPose


class TerminalDialogue:
    """Asks until the input ends.

    Args:
        joint_names: the joints that a line gives a position for, in its order.
        read_line: returns the next line, or None at the end of input or of the process.
        write: shows a text to the person, as it is.
        deliver: checks and publishes a pose once it can arrive, calling its second argument
            right before; raises PoseError or DeliveryError.
    """

    def __init__(
        self,
        joint_names: Sequence[str],
        read_line: Callable[[], str | None],
        write: Callable[[str], None],
        deliver: Callable[[JointPose, Callable[[], None]], None],
    ) -> None:
        self._joint_names = tuple(joint_names)
        self._read_line = read_line
        self._write = write
        self._deliver = deliver

    def run(self) -> bool:
        """Talk until the end of input; return whether every good line was delivered."""
        all_delivered = True
        while True:
            self._write(prompt(self._joint_names))
            line = self._read_line()
            if line is None:
                self._write("\n")
                return all_delivered
            try:
                self._publish(parse_pose_line(line, self._joint_names))
            except (CommandLineError, PoseError) as error:
                self._write(f"{error}\n")
            except DeliveryError as error:
                all_delivered = False
                self._write(f"{error}\n")

    def _publish(self, pose: JointPose) -> None:
        self._deliver(pose, lambda: self._write(f"Publishing: {pose}\n"))
