"""Snapshots and named values of a controller manager, under ros2_control's names."""

from collections.abc import Iterator
from math import nan

import numpy as np
from numpy.typing import NDArray

from arm_control.lifecycle import LifecycleState, Transition
from arm_control.loop.supervision import RunRecord, Spread
from arm_control.manager.controller_manager import ControllerManager
from arm_control.status import InterfaceStatus
from arm_node.frozen import frozen


class ManagerSnapshot:
    """Controllers, components and interfaces after the last change.

    It observes the manager (`ManagerObserver`, loop thread). It is up to date before the client
    that requested a change gets its answer. Each attribute is replaced as a whole, so any thread
    may read it at any time, even while the control loop is stuck in a controller.

    Attributes:
        controllers: every loaded controller and the record of its updates, the newest first.
        components: every hardware component and the records of its reads and writes.
        interfaces: the command and the state interfaces, each sorted by name.
    """

    def __init__(self, manager: ControllerManager) -> None:
        """Take the first snapshot; loop thread."""
        self._manager = manager
        self.activity_changed()

    def controller_transitioned(
        self, name: str, transition: Transition, start: LifecycleState, end: LifecycleState
    ) -> None:
        """Do nothing: `activity_changed` follows."""

    def activity_changed(self) -> None:
        """Take a new snapshot; loop thread."""
        self.controllers = self._manager.controller_runs()
        self.components = self._manager.resources.component_runs()
        self.interfaces = self._manager.list_hardware_interfaces()


@frozen
class NamedValues:
    """Named values at one moment.

    Attributes:
        names: the same object until one is added or removed.
        values: in the order of the names, shape (n,).
    """

    names: tuple[str, ...]
    values: NDArray[np.float64]


class InterfaceValues:
    """The values of all command and state interfaces that are numbers. Loop thread only."""

    def __init__(self, manager: ControllerManager, snapshot: ManagerSnapshot) -> None:
        self._manager = manager
        self._snapshot = snapshot
        self._listed: object = None

    def sample(self) -> NamedValues:
        """Return a copy of the current values."""
        if self._snapshot.interfaces is not self._listed:
            self._list()
        return NamedValues(
            self._names, np.concatenate([self._commands.read(), self._states.read()])
        )

    def _list(self) -> None:
        self._listed = self._snapshot.interfaces
        commands, states = (_numbers(kind) for kind in self._snapshot.interfaces)
        self._commands = self._manager.resources.loan_commands(commands)
        self._states = self._manager.resources.loan_states(states)
        self._names = (
            *(f"command_interface.{name}" for name in commands),
            *(f"state_interface.{name}" for name in states),
        )


class ManagerStatistics:
    """Recent rates and execution times of controllers, components and the loop."""

    def __init__(self, manager: ControllerManager, snapshot: ManagerSnapshot, name: str) -> None:
        self._manager = manager
        self._snapshot = snapshot
        self._name = name
        self._names: tuple[str, ...] = ()

    def sample(self) -> NamedValues:
        """Return the current figures: times in microseconds, rates in Hz; one thread."""
        figures = dict(self._figures())
        names = tuple(figures)
        if names != self._names:
            self._names = names
        return NamedValues(self._names, np.array(list(figures.values())))

    def _figures(self) -> Iterator[tuple[str, float]]:
        components = self._snapshot.components
        update_us = self._manager.updates.latest_us
        read_us = sum(reads.latest_us for _, reads, _ in components)
        write_us = sum(writes.latest_us for _, _, writes in components)
        yield f"{self._name}.update_time", update_us
        yield f"{self._name}.read_time", read_us
        yield f"{self._name}.write_time", write_us
        yield f"{self._name}.total_time", update_us + read_us + write_us
        yield from _of(f"{self._name}.periodicity", *_rate(self._manager.updates))
        for status, runs in self._snapshot.controllers:
            yield from _of_runs(f"{status.name}.stats", runs)
        for status, reads, writes in components:
            yield from _of_runs(f"{status.name}.stats/read_cycle", reads)
            yield from _of_runs(f"{status.name}.stats/write_cycle", writes)


def _numbers(interfaces: tuple[InterfaceStatus, ...]) -> tuple[str, ...]:
    return tuple(item.name for item in interfaces if item.data_type == "double")


def _of_runs(prefix: str, runs: RunRecord) -> Iterator[tuple[str, float]]:
    statistics = runs.statistics()
    spread = None if statistics is None else statistics.execution_time_us
    yield from _of(f"{prefix}/execution_time", spread, runs.latest_us)
    yield from _of(f"{prefix}/periodicity", *_rate(runs))


def _rate(runs: RunRecord) -> tuple[Spread | None, float]:
    statistics = runs.statistics()
    return None if statistics is None else statistics.periodicity_hz, runs.latest_hz


def _of(prefix: str, spread: Spread | None, latest: float) -> Iterator[tuple[str, float]]:
    known = spread or Spread(nan, nan, nan, nan)
    yield f"{prefix}/max", known.maximum
    yield f"{prefix}/min", known.minimum
    yield f"{prefix}/average", known.mean
    yield f"{prefix}/standard_deviation", known.standard_deviation
    yield f"{prefix}/current_value", latest
