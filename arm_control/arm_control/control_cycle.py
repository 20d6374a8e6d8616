"""One cycle of a controller manager whose hardware goes by the clock."""

from math import nan

from arm_control.clock import Clock
from arm_control.controller_manager import ControllerManager


class ControlCycle:
    """States, controllers, commands, broadcasters. Called on the loop thread only.

    The commands leave before the broadcasters run: hardware need not wait for publishing.
    """

    def __init__(
        self, manager: ControllerManager, clock: Clock, ticker: Clock | None = None
    ) -> None:
        """Prepare the cycle.

        Args:
            manager: the core.
            clock: its time: of the states, and of the controllers' stamps.
            ticker: measures the periods where somebody may set the clock; None for the clock
                itself.
        """
        self._manager = manager
        self._now_s = clock.now_s
        self._tick_s = (ticker or clock).now_s
        self._nominal_period_s = 1.0 / manager.update_rate_hz
        self._last_s = nan

    def __call__(self) -> None:
        """Run one cycle, with the time since the last one as its period.

        The period is the nominal one in the first cycle, and where the ticker did not advance.
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
