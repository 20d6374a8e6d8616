"""One hardware component of the manager: its driver and its life cycle."""

import logging
from collections.abc import Callable
from typing import Any

from arm_control.errors import StateError
from arm_control.hardware.driver import Hardware, HardwareReturn, Resettable
from arm_control.lifecycle import LifecycleState, Transition
from arm_control.loop.schedule import Cadence, achievable_rate_hz
from arm_control.loop.supervision import RunRecord, RunSupervision, failure_of
from arm_control.state.attributes import Stateful

logger = logging.getLogger("controller_manager")

# Looked up once: in Python 3.11 a member of an enum takes as long as a call.
_OK, _DEACTIVATE = HardwareReturn.OK, HardwareReturn.DEACTIVATE


class HardwareComponent:
    """A driver and its life-cycle state. Loop thread only.

    Attributes:
        hardware: the driver.
        rate_hz: the actual rate at which it is read and written.
        state: its life-cycle state.
        reads: its latest reads, with the periods passed to them.
        writes: its latest writes, with the periods passed to them.
    """

    def __init__(
        self, hardware: Hardware, cycle_rate_hz: int, supervision: RunSupervision | None = None
    ) -> None:
        """Take ownership of an unconfigured driver, whose rate is at most that of the cycles."""
        self.hardware = hardware
        self.state = LifecycleState.UNCONFIGURED
        supervision = supervision or RunSupervision()
        self.reads = supervision.record()
        self.writes = supervision.record()
        owner, info = f"hardware component '{self.name}'", hardware.info
        self.rate_hz = achievable_rate_hz(owner, info.read_write_rate_hz, cycle_rate_hz)
        self._reading = Cadence(self.rate_hz, cycle_rate_hz)
        self._writing = Cadence(self.rate_hz, cycle_rate_hz)
        if info.is_async:
            logger.warning("%s has is_async set; it runs on the control loop's thread here", owner)
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
        """Go to a state, step by step; return why it failed, or an empty string."""
        while self.state is not target:
            if self.state is LifecycleState.FINALIZED:
                return f"hardware component '{self.name}' is finalized; it cannot leave that state"
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
        """Treat the next read and the next write as the first ones."""
        for cadence, runs in ((self._reading, self.reads), (self._writing, self.writes)):
            cadence.restart()
            runs.clear()

    def reset(self) -> None:
        """Start over after the simulation was reset."""
        self.restart_cadence()
        if isinstance(self.hardware, Resettable):
            self.hardware.reset()

    def save_state(self) -> Any:
        """Return when the driver runs next, and its state.

        Raises:
            StateError: the driver has no `save_state` and `load_state`.
        """
        driver = self.hardware
        if not isinstance(driver, Stateful):
            raise StateError(
                f"hardware component '{self.name}' cannot be saved: its driver, "
                f"{type(driver).__name__}, has no save_state and load_state"
            )
        return self._reading.save_state(), self._writing.save_state(), driver.save_state()

    def load_state(self, state: Any) -> None:
        """Continue from a saved state."""
        reading, writing, driver = state
        self._reading.load_state(reading)
        self._writing.load_state(writing)
        if isinstance(self.hardware, Stateful):
            self.hardware.load_state(driver)

    def fail(self) -> None:
        """Clean up after an error: unconfigured afterwards, or finalized if the clean-up fails."""
        reason = failure_of(
            self.hardware.on_cleanup, f"on_cleanup of hardware component '{self.name}'"
        )
        self.state = LifecycleState.FINALIZED if reason else LifecycleState.UNCONFIGURED

    def read(self, time_s: float, period_s: float) -> HardwareReturn:
        """Read the states if a read is due; an exception counts as ERROR."""
        cadence = self._reading
        due_s = cadence.due_period_s(time_s, period_s) if cadence.skips else period_s
        if due_s is None:
            return _OK
        return self._exchange(self.hardware.read, self.reads, time_s, due_s)

    def write(self, time_s: float, period_s: float) -> HardwareReturn:
        """Write the commands if a write is due; an exception counts as ERROR."""
        cadence = self._writing
        due_s = cadence.due_period_s(time_s, period_s) if cadence.skips else period_s
        if due_s is None:
            return _OK
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
            # A driver is user code and may raise even SystemExit. By default the manager shuts the
            # component off and goes on.
            self._on_exception(f"hardware component '{self.name}' failed", error)
            return HardwareReturn.ERROR
        runs.add_period(period_s)
        runs.add_duration(self._now_s() - began_s)
        if outcome is _DEACTIVATE and self.state is not LifecycleState.ACTIVE:
            # It is already inactive: a driver may repeat its request in every read.
            return _OK
        return outcome

    def _step_towards(self, target: LifecycleState) -> Transition:
        if target is LifecycleState.FINALIZED:
            return Transition.SHUTDOWN
        if target > self.state:
            unconfigured = self.state is LifecycleState.UNCONFIGURED
            return Transition.CONFIGURE if unconfigured else Transition.ACTIVATE
        active = self.state is LifecycleState.ACTIVE
        return Transition.DEACTIVATE if active else Transition.CLEANUP
