"""When sensors are read and published."""

from dataclasses import dataclass, field

import numpy as np
import pytest

from arm_gazebo.hardware.simulated_sensors import SensorFeed
from arm_gazebo.sensors.imu import ImuSensor

PERIOD_S = 0.01


@dataclass
class SimulatedSensor:
    """Reads how often it was read."""

    description: ImuSensor
    reads: int = 0

    def read(self) -> np.ndarray:
        self.reads += 1
        return np.array([self.reads])


@dataclass
class Sink:
    """Remembers what was published."""

    listened_to: bool = True
    times_s: list[float] = field(default_factory=list)

    def wanted(self) -> bool:
        return self.listened_to

    def publish(self, time_s: float, reading: np.ndarray) -> None:
        self.times_s.append(time_s)


class Feed:
    """Two sensors, one of which names no rate."""

    def __init__(self) -> None:
        self.sensors = [
            SimulatedSensor(ImuSensor("slow", "l", "l", "slow", rate_hz=25.0)),
            SimulatedSensor(ImuSensor("fast", "l", "l", "fast")),
        ]
        self.sinks = [Sink(), Sink()]
        self.feed = SensorFeed(self.sensors, self.sinks, PERIOD_S)

    def run(self, first: int, ticks: int) -> None:
        for tick in range(first, first + ticks):
            self.feed.publish_due(tick * PERIOD_S, None)


@pytest.fixture
def feed() -> Feed:
    return Feed()


def test_each_sensor_is_read_at_its_rate_and_one_without_in_each_period(feed):
    feed.run(1, 100)
    # The first tick shows what was due before it, too.
    assert len(feed.sinks[0].times_s) == 26
    assert len(feed.sinks[1].times_s) == 100
    assert feed.sinks[0].times_s[1:4] == pytest.approx([0.04, 0.08, 0.12])


def test_a_sensor_without_subscribers_is_not_read(feed):
    feed.sinks[1].listened_to = False
    feed.run(1, 50)
    assert feed.sensors[1].reads == 0
    feed.sinks[1].listened_to = True
    feed.run(51, 50)
    assert feed.sensors[1].reads == 50


def test_readings_go_on_when_time_jumps_back(feed):
    feed.run(1, 100)
    feed.run(1, 10)
    assert feed.sensors[1].reads == 110
