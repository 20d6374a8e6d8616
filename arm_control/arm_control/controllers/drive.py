"""A controller that drives wheels at a commanded twist: which commands it takes."""

from abc import abstractmethod
from collections import deque
from collections.abc import Sequence
from dataclasses import dataclass
from typing import ClassVar, Generic, TypeVar

from arm_control.controllers.controller import (
    CHAINED,
    NOT_ACTIVE,
    ChainableController,
    ControllerContext,
    ParametersT,
)
from arm_control.errors import ControllerError
from arm_control.run_inputs import run_input

TwistT = TypeVar("TwistT")

NO_COVARIANCE = (0.0,) * 6
"""Default of the parameters `pose_covariance_diagonal` and `twist_covariance_diagonal`."""


def check_covariances(pose: Sequence[float], twist: Sequence[float]) -> None:
    """Raise `ControllerError` if one of the two diagonals does not have six numbers."""
    for name, diagonal in (("pose", pose), ("twist", twist)):
        if len(diagonal) != len(NO_COVARIANCE):
            raise ControllerError(
                f"parameter '{name}_covariance_diagonal' takes {len(NO_COVARIANCE)} numbers, "
                f"not {len(diagonal)}"
            )


@dataclass(frozen=True, slots=True)
class StampedTwist(Generic[TwistT]):
    """A commanded twist and the time of its command in the controller's time."""

    twist: TwistT
    stamp_s: float


class DriveController(ChainableController[ParametersT], Generic[ParametersT, TwistT]):
    """Takes commanded twists while it is active and no other controller commands it.

    The latest command wins. One that is older than the timeout is refused.

    Attributes:
        twist_type: class of the twists; its arguments are the values of `reference_names`.
        timeout_parameter: the parameter that has the timeout in s; 0 is none.
    """

    twist_type: ClassVar[type]
    timeout_parameter: ClassVar[str]

    def __init__(self, context: ControllerContext) -> None:
        super().__init__(context)
        self._offered: deque[StampedTwist[TwistT]] = deque(maxlen=1)
        self._command: StampedTwist[TwistT] | None = None
        # `update_commands` sets it: commands are taken from the first update on.
        self._now_s: float | None = None

    @abstractmethod
    def reason_to_refuse(self, twist: TwistT) -> str:
        """Return why the wheels cannot move the robot at this twist; empty if they can."""

    @run_input
    def offer(self, twist: TwistT, stamp_s: float | None) -> str:
        """Drive at this twist from the next cycle on, until the timeout; any thread.

        Args:
            twist: the commanded twist.
            stamp_s: time of the command in the controller's time; None for now. A stamp in the
                future counts as now, because it comes from another clock and would delay the
                timeout.

        Returns:
            Why it was refused; empty if it was accepted.
        """
        now_s = self._now_s
        if now_s is None:
            return self.idle_reason or NOT_ACTIVE
        if self.is_chained:
            return CHAINED
        if reason := self.reason_to_refuse(twist):
            return reason
        stamp_s = now_s if stamp_s is None else min(stamp_s, now_s)
        age_s = now_s - stamp_s
        timeout_s: float = getattr(self.parameters, self.timeout_parameter)
        if timeout_s and age_s > timeout_s:
            return (
                f"its stamp is {age_s:.3f} s old, and {self.timeout_parameter} is {timeout_s:g} s"
            )
        self._offered.append(StampedTwist(twist, stamp_s))
        return ""

    def take_command(self, values: Sequence[float]) -> None:
        """Take the values of a twist in the order of `reference_names`; see `offer`.

        Raises:
            ControllerError: the command is refused.
        """
        count = len(self.reference_names())
        if len(values) != count:
            raise ControllerError(f"a command has {count} values, not {len(values)}")
        reason = self.offer(self.twist_type(*map(float, values)), None)
        if reason:
            raise ControllerError(f"a command was dropped: {reason}")

    def on_set_chained_mode(self, is_chained: bool) -> None:
        """Drop the commands from before the change."""
        self._forget_commands()

    def on_deactivate(self) -> None:
        """Stop the wheels."""
        self._now_s = None
        self._forget_commands()
        self.commands.write(0.0)

    def _latest_command(self) -> StampedTwist[TwistT] | None:
        if self._offered:
            self._command = self._offered.pop()
        return self._command

    def _forget_commands(self) -> None:
        self._offered.clear()
        self._command = None
