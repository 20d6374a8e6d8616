"""A controller to watch, and a manager over fake hardware."""

from collections.abc import Callable
from dataclasses import dataclass
from typing import Any

import pytest
from manager_bench import ManagerBench

from arm_control import (
    Controller,
    ControllerContext,
    ControllerError,
    InterfaceConfiguration,
    ReturnType,
)
from arm_control.lifecycle import LifecycleState, Transition
from arm_control.testing import FakeHardware, fake_hardware


@dataclass(frozen=True, slots=True)
class ProbeParameters:
    """The interfaces that the probe requests."""

    commands: tuple[str, ...] = ()
    states: tuple[str, ...] = ()


class Probe(Controller[ProbeParameters]):
    """Records its calls in a list that all probes share, and fails on demand."""

    parameters_type = ProbeParameters

    def __init__(self, context: ControllerContext, events: list[str]) -> None:
        super().__init__(context)
        self.events = events
        self.updates: list[tuple[float, float]] = []
        self.refuses: set[str] = set()
        self.raises: set[str] = set()
        self.fails_update = False
        self._parameters = ProbeParameters()

    def command_interface_configuration(self) -> InterfaceConfiguration:
        return InterfaceConfiguration.individual(self._parameters.commands)

    def state_interface_configuration(self) -> InterfaceConfiguration:
        return InterfaceConfiguration.individual(self._parameters.states)

    def on_configure(self, parameters: ProbeParameters) -> None:
        self._note("configure")
        self._parameters = parameters

    def on_activate(self) -> None:
        self._note("activate")

    def update(self, time_s: float, period_s: float) -> ReturnType:
        self.updates.append((time_s, period_s))
        self._note("update")
        return ReturnType.ERROR if self.fails_update else ReturnType.OK

    def on_deactivate(self) -> None:
        self._note("deactivate")

    def on_cleanup(self) -> None:
        self._note("cleanup")

    def on_shutdown(self) -> None:
        self._note("shutdown")

    def _note(self, event: str) -> None:
        self.events.append(f"{self.name} {event}")
        if event in self.refuses:
            raise ControllerError(f"{self.name} does not want to {event}")
        if event in self.raises:
            raise RuntimeError(f"{self.name} broke in {event}")


class Observer:
    """Records what a manager reports."""

    def __init__(self) -> None:
        self.transitions: list[tuple[str, str, LifecycleState, LifecycleState]] = []
        self.changes = 0

    def controller_transitioned(
        self, name: str, transition: Transition, start: LifecycleState, end: LifecycleState
    ) -> None:
        self.transitions.append((name, transition.label, start, end))

    def activity_changed(self) -> None:
        self.changes += 1


class Bench(ManagerBench):
    """A manager at 100 Hz over four fake joints, and probes loaded into it."""

    def __init__(self) -> None:
        super().__init__(fake_hardware())
        self.events: list[str] = []

    def load(self, name: str, *, fallback_names: tuple[str, ...] = ()) -> Probe:
        """Load a probe."""
        probe = Probe(ControllerContext(name, 100), self.events)
        self.manager.load_controller(probe, "test/Probe", fallback_names)
        return probe

    def configure(
        self,
        name: str,
        *,
        commands: tuple[str, ...] = (),
        states: tuple[str, ...] = (),
        rate_hz: int = 0,
        fallback_names: tuple[str, ...] = (),
    ) -> Probe:
        """Load and configure a probe."""
        probe = self.load(name, fallback_names=fallback_names)
        self.manager.configure_controller(name, ProbeParameters(commands, states), rate_hz)
        return probe

    def states(self) -> dict[str, str]:
        """Return the state of each controller."""
        return {status.name: status.state.label for status in self.manager.list_controllers()}


@pytest.fixture
def bench() -> Bench:
    """Return a manager over fake hardware."""
    return Bench()


@pytest.fixture
def observer(bench: Bench) -> Observer:
    """Return an observer of the bench's manager."""
    observer = Observer()
    bench.manager.add_observer(observer)
    return observer


@pytest.fixture
def hardware() -> FakeHardware:
    """Return fake hardware of four joints without a manager."""
    return fake_hardware()


@pytest.fixture
def make(bench: Bench) -> Callable[[type[Controller[Any]], Any], Any]:
    """Return a function that loads, configures and returns a controller named 'it'."""

    def load_and_configure(class_: type[Controller[Any]], parameters: Any) -> Any:
        controller = class_(ControllerContext("it", 100))
        bench.manager.load_controller(controller, "test/It")
        bench.manager.configure_controller("it", parameters)
        return controller

    return load_and_configure
