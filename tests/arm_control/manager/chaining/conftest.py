"""Controllers that hang together, and hardware under them."""

from collections.abc import Callable
from dataclasses import dataclass
from typing import Any

import numpy as np
import pytest

from arm_control import (
    ControllerContext,
    ControllerError,
    InterfaceConfiguration,
    ReturnType,
    SwitchRequest,
)
from arm_control.controllers.controller import ChainableController
from arm_control.controllers.forward_command.controller import (
    ForwardCommandController,
    ForwardCommandParameters,
)
from arm_control.controllers.joint_state_broadcaster.controller import (
    JointStateBroadcaster,
    JointStateBroadcasterParameters,
)
from arm_control.manager.switch_planner import Strictness, SwitchResult


@dataclass(frozen=True, slots=True)
class LinkParameters:
    commands: tuple[str, ...] = ()
    states: tuple[str, ...] = ()
    references: tuple[str, ...] = ()
    exported: tuple[str, ...] = ()


class Link(ChainableController[LinkParameters]):
    """Hands its references through to its commands, adding one; its own topic says `topic`."""

    parameters_type = LinkParameters

    def __init__(self, context: ControllerContext, runs: list[str]) -> None:
        super().__init__(context)
        self.runs = runs
        self.topic: float = np.nan
        self.fails = False
        self.refuses_to_start = False
        self.refuses_to_stop = False
        self._parameters = LinkParameters()

    def command_interface_configuration(self) -> InterfaceConfiguration:
        return InterfaceConfiguration.individual(self._parameters.commands)

    def state_interface_configuration(self) -> InterfaceConfiguration:
        return InterfaceConfiguration.individual(self._parameters.states)

    def reference_names(self) -> tuple[str, ...]:
        return self._parameters.references

    def exported_state_names(self) -> tuple[str, ...]:
        return self._parameters.exported

    def on_configure(self, parameters: LinkParameters) -> None:
        self._parameters = parameters

    def on_activate(self) -> None:
        if self.refuses_to_start:
            raise ControllerError(f"{self.name} does not want to start")

    def on_deactivate(self) -> None:
        if self.refuses_to_stop:
            raise ControllerError(f"{self.name} does not want to stop")

    def update_references(self, time_s: float, period_s: float) -> ReturnType:
        self.references[:] = self.topic
        return ReturnType.OK

    def update_commands(self, time_s: float, period_s: float) -> ReturnType:
        self.runs.append(self.name)
        if self.references.size == len(self.commands):
            self.commands.write(self.references + 1.0)
        self.exported_states[:] = self.states.read().sum()
        return ReturnType.ERROR if self.fails else ReturnType.OK


class ChainBench:
    """A bench with connected controllers."""

    def __init__(self, bench: Any) -> None:
        self.bench = bench
        self.manager = bench.manager
        self.runs: list[str] = []
        self.links: dict[str, Link] = {}

    def link(
        self,
        name: str,
        *,
        commands: tuple[str, ...] = (),
        states: tuple[str, ...] = (),
        references: tuple[str, ...] = (),
        exported: tuple[str, ...] = (),
        fallback_names: tuple[str, ...] = (),
    ) -> Link:
        """Load and configure a link."""
        link = self.links[name] = Link(ControllerContext(name, 100), self.runs)
        self.manager.load_controller(link, "test/Link", fallback_names)
        self.manager.configure_controller(
            name, LinkParameters(commands, states, references, exported)
        )
        return link

    def forwarder(self, name: str, joints: tuple[str, ...]) -> ForwardCommandController:
        """Load and configure a real forward_command_controller."""
        controller = ForwardCommandController(ControllerContext(name, 100))
        self.manager.load_controller(controller, "test/Forward")
        self.manager.configure_controller(name, ForwardCommandParameters(joints, "position"))
        return controller

    def broadcaster(self, name: str) -> JointStateBroadcaster:
        """Load and configure a joint_state_broadcaster of all states."""
        controller = JointStateBroadcaster(ControllerContext(name, 100))
        self.manager.load_controller(controller, "test/Broadcaster")
        self.manager.configure_controller(name, JointStateBroadcasterParameters())
        return controller

    def switch(
        self, activate: str = "", deactivate: str = "", strictness: Strictness = Strictness.STRICT
    ) -> SwitchResult:
        """Switch the controllers of these names, parted by blanks."""
        return self.manager.switch_controller(
            SwitchRequest(tuple(activate.split()), tuple(deactivate.split()), strictness)
        )

    def states(self) -> dict[str, str]:
        return self.bench.states()

    def status(self, name: str) -> Any:
        return next(s for s in self.manager.list_controllers() if s.name == name)

    def commands(self) -> list[float]:
        return self.manager.resources.commands.tolist()

    def interface(self, name: str) -> Any:
        commands, states = self.manager.list_hardware_interfaces()
        return next(i for i in (*commands, *states) if i.name == name)


@pytest.fixture
def chain(bench: Any) -> ChainBench:
    return ChainBench(bench)


@pytest.fixture
def new_chain(bench: Any) -> Callable[[], ChainBench]:
    """Return a function that makes a new bench."""
    return lambda: ChainBench(type(bench)())


@pytest.fixture
def pair(chain: ChainBench) -> ChainBench:
    """`low` commands j0; `high` commands the reference of `low`."""
    chain.link("low", commands=("j0/position",), references=("x/position",))
    chain.link("high", commands=("low/x/position",), references=("y/position",))
    return chain
