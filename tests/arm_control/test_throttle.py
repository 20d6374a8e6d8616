"""One permission per interval."""

from arm_control.testing import ManualClock
from arm_control.throttle import Throttle


def test_it_permits_once_per_interval() -> None:
    clock = ManualClock()
    throttle = Throttle(1.0, clock)
    permits = []
    for _ in range(25):
        permits.append(throttle.permits())
        clock.advance(0.125)
    assert [i for i, permitted in enumerate(permits) if permitted] == [0, 8, 16, 24]
