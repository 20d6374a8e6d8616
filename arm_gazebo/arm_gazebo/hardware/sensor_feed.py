"""Reads the robots' sensors at their rates, for whoever listens."""

from collections.abc import Sequence

import mujoco

from arm_control.sensor_broadcaster import ReadingSink
from arm_gazebo.feed.schedule import FrameSchedule
from arm_gazebo.hardware.instrument import Instrument


class SensorFeed:
    """Publishes what sensors read. Nothing is computed for a sensor to which nobody listens.

    Args:
        instruments: the sensors.
        sinks: where the readings of each go.
        period_s: control period; the rate of a sensor that names none.
    """

    def __init__(
        self, instruments: Sequence[Instrument], sinks: Sequence[ReadingSink], period_s: float
    ) -> None:
        self._channels = tuple(zip(instruments, sinks, strict=True))
        self._schedule = FrameSchedule([i.sensor.rate_hz or 1 / period_s for i in instruments])

    def publish_due(self, time_s: float, data: mujoco.MjData) -> None:
        """Publish the readings that are due at this tick; loop thread."""
        if self._schedule.nothing_due(time_s):
            return
        for due in self._schedule.take_due(time_s):
            instrument, sink = self._channels[due.camera]
            if sink.wanted():
                sink.publish(time_s, instrument.read())
