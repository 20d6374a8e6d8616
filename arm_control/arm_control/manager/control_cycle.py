"""One control cycle: read, update, write, publish."""

from math import nan

from arm_control.loop.clock import Clock
from arm_control.manager.controller_manager import ControllerManager


class ControlCycle:
    """Reads states, updates controllers, writes commands, runs broadcasters. Loop thread only.

    Commands are written before the broadcasters run, so that hardware need not wait for publishing.
    """

    def __init__(
        self, manager: ControllerManager, clock: Clock, ticker: Clock | None = None
    ) -> None:
        """Prepare the cycle.

        Args:
            manager: the core.
            clock: time of the states, used for the controllers' stamps.
            ticker: measures the periods if `clock` may be set; None uses `clock`.
        """
        self._manager = manager
        self._now_s = clock.now_s
        self._tick_s = (ticker or clock).now_s
        self._nominal_period_s = 1.0 / manager.update_rate_hz
        self._last_s = nan

    def __call__(self) -> None:
        """Run one cycle; its period is the time since the last one.

        The period is the nominal one for the first cycle, and if the ticker has not advanced.
        """
        manager, time_s, tick_s = self._manager, self._now_s(), self._tick_s()
        period_s = tick_s - self._last_s
        if not period_s > 0.0:
            period_s = self._nominal_period_s
        self._last_s = tick_s
        manager.read(time_s, period_s)
        manager.update(time_s, period_s)
        manager.write(time_s, period_s)
        manager.publish(time_s, period_s)
