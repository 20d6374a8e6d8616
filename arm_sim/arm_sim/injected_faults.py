"""What all faults on demand share: those that a simulation injects into itself, and their log."""

import math
from collections.abc import Callable, Iterator
from contextlib import AbstractContextManager, contextmanager
from dataclasses import dataclass

from arm_gazebo.faults.fault import Fault, FaultKind


@dataclass(slots=True)
class FaultSpan:
    """A span of time with a fault.

    Attributes:
        name: the fault's name in reports.
        began_s: when it began, in simulation time.
        ended_s: when it ended; inf while it lasts.
    """

    name: str
    began_s: float
    ended_s: float = math.inf

    def __str__(self) -> str:
        until = "" if self.ended_s == math.inf else f" to {self.ended_s:.3f} s"
        return f"fault: {self.name}, from {self.began_s:.3f} s{until}"


class FaultLog:
    """Records the faults of a test. One thread.

    Attributes:
        spans: the faults so far, in the order in which they began.
    """

    def __init__(self, now_s: Callable[[], float]) -> None:
        self.spans: list[FaultSpan] = []
        self._now_s = now_s

    @contextmanager
    def noted(self, name: str) -> Iterator[None]:
        """Record a fault that lasts as long as the `with` block."""
        span = FaultSpan(name, self._now_s())
        self.spans.append(span)
        try:
            yield
        finally:
            span.ended_s = self._now_s()

    def restart(self) -> None:
        """Forget the faults that have ended; those that still last count from now on."""
        self.spans = [span for span in self.spans if span.ended_s == math.inf]
        for span in self.spans:
            span.began_s = self._now_s()


Change = Callable[[Fault], None]


class InjectedFaults:
    """Faults that a simulation injects into itself; each lasts as long as its `with` block.

    Attributes:
        log: the faults so far.
    """

    def __init__(
        self,
        now_s: Callable[[], float],
        begin: Callable[[Fault], None],
        end: Callable[[Fault], None],
    ) -> None:
        """Take what tells the time, and what begins and ends a fault in the simulation."""
        self.log = FaultLog(now_s)
        self._begin, self._end = begin, end

    def joint_stalled(self, joint: str) -> AbstractContextManager[None]:
        """Make a joint stick where it is, whatever its drive does."""
        return self._injected(Fault(FaultKind.JOINT_STALLED, joint))

    def sensor_frozen(self, name: str) -> AbstractContextManager[None]:
        """Freeze readings at their present values.

        Controllers and broadcasters see the frozen values; the library's `sim.joints` shows the
        true states.

        Args:
            name: a channel such as j0/position; or a joint or sensor, for all of its channels.
        """
        return self._injected(Fault(FaultKind.SENSOR_FROZEN, name))

    def sensor_noisy(
        self, name: str, deviation: float, seed: int = 0
    ) -> AbstractContextManager[None]:
        """Add Gaussian noise to readings; see `sensor_frozen`.

        Args:
            name: as for `sensor_frozen`.
            deviation: standard deviation, in the unit of the reading.
            seed: of the noise.
        """
        return self._injected(Fault(FaultKind.SENSOR_NOISY, name, deviation, seed))

    def sensor_nan(self, name: str) -> AbstractContextManager[None]:
        """Make readings NaN; see `sensor_frozen`."""
        return self._injected(Fault(FaultKind.SENSOR_NAN, name))

    def controller_raises(self, name: str) -> AbstractContextManager[None]:
        """Make a controller's updates raise: the manager deactivates it, or starts its fallback.

        It stays inactive after the block.
        """
        return self._injected(Fault(FaultKind.CONTROLLER_RAISES, name))

    def slow_tick(self, seconds: float) -> AbstractContextManager[None]:
        """Make each control period take this many seconds of wall time longer."""
        return self._injected(Fault(FaultKind.SLOW_TICK, amount=seconds))

    @contextmanager
    def _injected(self, fault: Fault) -> Iterator[None]:
        self._begin(fault)
        with self.log.noted(str(fault)):
            try:
                yield
            finally:
                self._end(fault)
