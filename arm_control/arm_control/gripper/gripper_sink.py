"""Where the news of a gripper controller go."""

from typing import Protocol

from arm_control.gripper.results import GripperResult


class GripperSink(Protocol):
    """Called on the loop thread, so it must be quick."""

    def open(self) -> None:
        """Get ready for goals; called at each activation."""
        ...

    def finish_goal(self, goal_id: object, result: GripperResult) -> None:
        """End a goal; called once for each goal that was taken, in the cycle of its end."""
        ...
