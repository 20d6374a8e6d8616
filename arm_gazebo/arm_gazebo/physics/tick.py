"""One control period of the whole simulation, in the order of least latency."""

from collections.abc import Sequence
from dataclasses import dataclass
from typing import Protocol

import mujoco

from arm_control.loop.clock import MonotonicClock
from arm_control.manager.controller_manager import ControllerManager
from arm_gazebo.physics.physics import Physics


class ClockPublisher(Protocol):
    """Publishes the simulation time."""

    def publish(self, time_s: float) -> None:
        """Publish a simulation time; called on the loop thread."""
        ...


class SilentClock:
    """A `ClockPublisher` for programs in which nobody listens to the time."""

    def publish(self, time_s: float) -> None:
        """Do nothing."""


class Feed(Protocol):
    """A consumer of states: cameras, sensors, a window."""

    def publish_due(self, time_s: float, data: mujoco.MjData) -> None:
        """Take the state if one is due. Called on the loop thread; must not wait."""
        ...


@dataclass(slots=True)
class TickCosts:
    """Wall time in s that all ticks so far have spent in each of their phases.

    Attributes:
        ticks: the number of ticks.
        update: controllers that command.
        write: commands to the drives.
        physics: MuJoCo and the drives.
        read: states from the physics.
        publish: clock, broadcasters, sensors, and states for the cameras.
    """

    ticks: int = 0
    update: float = 0.0
    write: float = 0.0
    physics: float = 0.0
    read: float = 0.0
    publish: float = 0.0


class SimulationTick:
    """Commands, physics, states, clock, broadcasters, feeds. Called on the loop thread only.

    Received commands are applied before the physics advances, and the new state is published in
    the same tick, so a command is visible in the very next /joint_states.

    Attributes:
        costs: what the ticks have cost so far; nothing in the simulation depends on it.
    """

    def __init__(
        self,
        managers: Sequence[ControllerManager],
        simulation: Physics,
        clock: ClockPublisher,
    ) -> None:
        self._managers = tuple(managers)
        self._simulation = simulation
        self._clock = clock
        self._feeds: list[Feed] = []
        self._period_s = simulation.timing.period_s
        self.costs = TickCosts()
        self._now_s = MonotonicClock.now_s

    def add_feed(self, feed: Feed) -> None:
        """Pass the states to a feed from the next tick on. Loop thread, between two ticks."""
        self._feeds.append(feed)

    def remove_feed(self, feed: Feed) -> None:
        """Stop passing states to a feed. Loop thread, between two ticks."""
        self._feeds.remove(feed)

    def __call__(self) -> None:
        """Advance everything by one control period."""
        managers, simulation, period_s = self._managers, self._simulation, self._period_s
        now_s, costs = self._now_s, self.costs
        time_s = simulation.time_s
        began_s = now_s()
        for manager in managers:
            manager.update(time_s, period_s)
        updated_s = now_s()
        for manager in managers:
            manager.write(time_s, period_s)
        written_s = now_s()
        simulation.advance()
        advanced_s = now_s()
        time_s = simulation.time_s
        for manager in managers:
            manager.read(time_s, period_s)
        read_s = now_s()
        # The clock comes first, so that no subscriber sees a stamp ahead of its own time.
        self._clock.publish(time_s)
        for manager in managers:
            manager.publish(time_s, period_s)
        for feed in self._feeds:
            feed.publish_due(time_s, simulation.data)
        costs.ticks += 1
        costs.update += updated_s - began_s
        costs.write += written_s - updated_s
        costs.physics += advanced_s - written_s
        costs.read += read_s - advanced_s
        costs.publish += now_s() - read_s
