"""One control period of the whole simulation, in the order that makes it quick to answer."""

from collections.abc import Sequence
from typing import Protocol

import mujoco

from arm_control.controller_manager import ControllerManager
from arm_gazebo.physics.simulation import Simulation


class ClockPublisher(Protocol):
    """Tells the world what time it is."""

    def publish(self, time_s: float) -> None:
        """Publish a simulation time; called on the loop thread."""
        ...


class Feed(Protocol):
    """Shows the simulation: cameras, a window."""

    def publish_due(self, time_s: float, data: mujoco.MjData) -> None:
        """Take the state if one is due; called on the loop thread, never waits."""
        ...


class SimulationTick:
    """Commands, physics, states, clock, broadcasters, feeds. Called on the loop thread only.

    The commands that came in are applied before physics moves on, and what physics made of them
    is published in the same tick: a command shows in the very next /joint_states.
    """

    def __init__(
        self,
        managers: Sequence[ControllerManager],
        simulation: Simulation,
        clock: ClockPublisher,
        feeds: Sequence[Feed],
        period_s: float,
    ) -> None:
        self._managers = tuple(managers)
        self._simulation = simulation
        self._clock = clock
        self._feeds = feeds
        self._period_s = period_s

    def __call__(self) -> None:
        """Advance everything by one control period."""
        managers, simulation, period_s = self._managers, self._simulation, self._period_s
        time_s = simulation.time_s
        for manager in managers:
            manager.update(time_s, period_s)
            manager.write(time_s, period_s)
        simulation.advance()
        time_s = simulation.time_s
        for manager in managers:
            manager.read(time_s, period_s)
        # The clock first: nobody shall see a stamp that lies ahead of the time they know.
        self._clock.publish(time_s)
        for manager in managers:
            manager.publish(time_s, period_s)
        for feed in self._feeds:
            feed.publish_due(time_s, simulation.data)
