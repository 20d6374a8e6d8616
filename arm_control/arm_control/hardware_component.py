"""One hardware component in the manager's care: its driver and its life cycle."""

import logging
from collections.abc import Callable

from arm_control.guarded import failure_of
from arm_control.hardware import Hardware, HardwareReturn
from arm_control.lifecycle import LifecycleState, Transition

logger = logging.getLogger(__name__)


class HardwareComponent:
    """A driver and the state it is in. Loop thread only.

    Attributes:
        hardware: the driver.
        state: of its life cycle.
    """

    def __init__(self, hardware: Hardware) -> None:
        self.hardware = hardware
        self.state = LifecycleState.UNCONFIGURED

    @property
    def name(self) -> str:
        """The component's name."""
        return self.hardware.info.name

    @property
    def is_available(self) -> bool:
        """Whether its interfaces may be used."""
        return self.state in (LifecycleState.INACTIVE, LifecycleState.ACTIVE)

    def go_to(self, target: LifecycleState) -> str:
        """Walk to a state, through those between; return why it stopped short, or nothing."""
        while self.state is not target:
            if self.state is LifecycleState.FINALIZED:
                return f"hardware component '{self.name}' is finalized; that is its end"
            step = self._step_towards(target)
            reason = failure_of(
                getattr(self.hardware, f"on_{step.label}"),
                f"on_{step.label} of hardware component '{self.name}'",
            )
            if reason:
                return reason
            self.state = step.goal
        return ""

    def fail(self) -> None:
        """Take the component down after an error: unconfigured, or finalized if it cannot."""
        reason = failure_of(
            self.hardware.on_cleanup, f"on_cleanup of hardware component '{self.name}'"
        )
        self.state = LifecycleState.FINALIZED if reason else LifecycleState.UNCONFIGURED

    def read(self, time_s: float, period_s: float) -> HardwareReturn:
        """Read the states; whatever the driver raises is an error of the component."""
        return self._exchange(self.hardware.read, time_s, period_s)

    def write(self, time_s: float, period_s: float) -> HardwareReturn:
        """Write the commands; whatever the driver raises is an error of the component."""
        return self._exchange(self.hardware.write, time_s, period_s)

    def _exchange(
        self,
        exchange: Callable[[float, float], HardwareReturn],
        time_s: float,
        period_s: float,
    ) -> HardwareReturn:
        try:
            return exchange(time_s, period_s)
        except Exception:
            # A driver is outside code; the manager takes the component down and goes on.
            logger.exception("hardware component '%s' failed", self.name)
            return HardwareReturn.ERROR

    def _step_towards(self, target: LifecycleState) -> Transition:
        if target is LifecycleState.FINALIZED:
            return Transition.SHUTDOWN
        if target > self.state:
            unconfigured = self.state is LifecycleState.UNCONFIGURED
            return Transition.CONFIGURE if unconfigured else Transition.ACTIVATE
        active = self.state is LifecycleState.ACTIVE
        return Transition.DEACTIVATE if active else Transition.CLEANUP
