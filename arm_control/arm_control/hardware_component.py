"""One hardware component in the manager's care: its driver and its life cycle."""

import logging
from collections.abc import Callable

from arm_control.cadence import Cadence, possible_rate_hz
from arm_control.guarded import failure_of
from arm_control.hardware import Hardware, HardwareReturn
from arm_control.lifecycle import LifecycleState, Transition
from arm_control.run_record import RunRecord
from arm_control.run_supervision import RunSupervision

logger = logging.getLogger(__name__)


class HardwareComponent:
    """A driver and the state it is in. Loop thread only.

    Attributes:
        hardware: the driver.
        rate_hz: how often it is really read and written.
        state: of its life cycle.
        reads: its latest reads, with the periods that they were told.
        writes: its latest writes, likewise.
    """

    def __init__(
        self, hardware: Hardware, cycle_rate_hz: int, supervision: RunSupervision | None = None
    ) -> None:
        """Take over a driver, still unconfigured.

        Args:
            hardware: the driver.
            cycle_rate_hz: cycles per second; of these its own rate picks some.
            supervision: of its reads and writes.
        """
        self.hardware = hardware
        self.state = LifecycleState.UNCONFIGURED
        supervision = supervision or RunSupervision()
        self.reads = supervision.record()
        self.writes = supervision.record()
        owner, info = f"hardware component '{self.name}'", hardware.info
        self.rate_hz = possible_rate_hz(owner, info.read_write_rate_hz, cycle_rate_hz)
        self._reading = Cadence(self.rate_hz, cycle_rate_hz)
        self._writing = Cadence(self.rate_hz, cycle_rate_hz)
        if info.is_async:
            logger.warning("%s has is_async set; it has no thread of its own here", owner)
        self._now_s = supervision.now_s
        self._on_exception = supervision.on_exception

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
            self.restart_cadence()
        return ""

    def restart_cadence(self) -> None:
        """Let the next read and the next write be the first."""
        for cadence, runs in ((self._reading, self.reads), (self._writing, self.writes)):
            cadence.restart()
            runs.clear()

    def fail(self) -> None:
        """Take the component down after an error: unconfigured, or finalized if it cannot."""
        reason = failure_of(
            self.hardware.on_cleanup, f"on_cleanup of hardware component '{self.name}'"
        )
        self.state = LifecycleState.FINALIZED if reason else LifecycleState.UNCONFIGURED

    def read(self, time_s: float, period_s: float) -> HardwareReturn:
        """Read the states if it is time; whatever the driver raises is the component's error."""
        due_s = self._reading.due_period_s(time_s, period_s)
        if due_s is None:
            return HardwareReturn.OK
        return self._exchange(self.hardware.read, self.reads, time_s, due_s)

    def write(self, time_s: float, period_s: float) -> HardwareReturn:
        """Write the commands if it is time; whatever the driver raises is the component's error."""
        due_s = self._writing.due_period_s(time_s, period_s)
        if due_s is None:
            return HardwareReturn.OK
        return self._exchange(self.hardware.write, self.writes, time_s, due_s)

    def _exchange(
        self,
        exchange: Callable[[float, float], HardwareReturn],
        runs: RunRecord,
        time_s: float,
        period_s: float,
    ) -> HardwareReturn:
        began_s = self._now_s()
        try:
            outcome = exchange(time_s, period_s)
        except KeyboardInterrupt:
            raise
        except BaseException as error:
            # A driver is outside code, so even SystemExit may come out of it; as a rule the manager
            # takes it down and goes on.
            self._on_exception(f"hardware component '{self.name}' failed", error)
            return HardwareReturn.ERROR
        runs.add(period_s, self._now_s() - began_s)
        if outcome is HardwareReturn.DEACTIVATE and self.state is not LifecycleState.ACTIVE:
            # What it asks for is so already: a driver may repeat itself in every read.
            return HardwareReturn.OK
        return outcome

    def _step_towards(self, target: LifecycleState) -> Transition:
        if target is LifecycleState.FINALIZED:
            return Transition.SHUTDOWN
        if target > self.state:
            unconfigured = self.state is LifecycleState.UNCONFIGURED
            return Transition.CONFIGURE if unconfigured else Transition.ACTIVATE
        active = self.state is LifecycleState.ACTIVE
        return Transition.DEACTIVATE if active else Transition.CLEANUP
