"""What a controller is: it declares the interfaces it uses, and computes one cycle at a time."""

import logging
from abc import ABC, abstractmethod
from collections.abc import Mapping
from dataclasses import dataclass
from enum import Enum
from typing import Any, ClassVar, Generic, TypeVar

import numpy as np

from arm_control.errors import ControllerError
from arm_control.interface_configuration import InterfaceConfiguration
from arm_control.loaned_interfaces import LoanedInterfaces
from arm_control.parameters import ParameterSpec, build_parameters, specs_of


class ReturnType(Enum):
    """Outcome of one update."""

    OK = "ok"
    ERROR = "error"
    """The manager deactivates the controller; log the reason before returning this."""


@dataclass(frozen=True, slots=True)
class NoParameters:
    """The parameters of a controller that has none."""


@dataclass(frozen=True, slots=True)
class ControllerContext:
    """What a controller is told about its surroundings when it is made.

    Attributes:
        name: the controller's own name, 'position_controller'.
        update_rate_hz: how often `update` will be called.
        robot_description: the URDF; empty where there is none.
    """

    name: str
    update_rate_hz: int
    robot_description: str = ""


ParametersT = TypeVar("ParametersT")

_NOTHING = LoanedInterfaces((), np.empty(0), ())


class Controller(ABC, Generic[ParametersT]):
    """Base class of all controllers: no ROS, no hardware of its own.

    The constructor and the class methods about parameters run on a control-plane thread,
    everything else on the loop thread. A life-cycle method that raises refuses the transition:
    `ControllerError` with a sentence for the user; anything else counts as a bug and is logged
    with its traceback.

    Attributes:
        parameters_type: frozen dataclass of the controller's parameters, see
            `arm_control.parameters`.
        adapter: the ROS half as 'module:Class', imported only where there is a node; empty for a
            controller that needs no topics.
    """

    parameters_type: ClassVar[type[Any]] = NoParameters
    adapter: ClassVar[str] = ""

    def __init__(self, context: ControllerContext) -> None:
        """Set up what needs no parameters; raise `ControllerError` to refuse being loaded."""
        self.context = context
        self.name = context.name
        self.logger = logging.getLogger(context.name)
        self.commands = _NOTHING
        self.states = _NOTHING
        self._parameters: ParametersT | None = None

    @property
    def parameters(self) -> ParametersT:
        """The parameters in force, as `on_configure` and `update_parameters` took them.

        Raises:
            ControllerError: the controller is not configured.
        """
        if self._parameters is None:
            raise ControllerError(f"controller '{self.name}' is not configured")
        return self._parameters

    @classmethod
    def parameter_specs(cls, given: Mapping[str, Any]) -> tuple[ParameterSpec, ...]:
        """Return the controller's parameters.

        Override it where the names of some depend on the values of others.

        Args:
            given: what parameter files and arguments say, by full name.
        """
        return specs_of(cls.parameters_type)

    @classmethod
    def build_parameters(cls, values: Mapping[str, Any]) -> ParametersT:
        """Return the values of all `parameter_specs` as what `on_configure` takes.

        Raises:
            ParameterError: a value cannot be used.
        """
        return build_parameters(cls.parameters_type, values)

    @abstractmethod
    def command_interface_configuration(self) -> InterfaceConfiguration:
        """Say which command interfaces to claim at activation; asked after `on_configure`."""

    @abstractmethod
    def state_interface_configuration(self) -> InterfaceConfiguration:
        """Say which state interfaces to read; asked after `on_configure`."""

    def on_configure(self, parameters: ParametersT) -> None:
        """Take the parameters: they are `self.parameters` from now on."""
        self._parameters = parameters

    def update_parameters(self, parameters: ParametersT) -> None:
        """Take parameters that a client changed since `on_configure`, between two updates.

        Read-only ones are as before. By default `self.parameters` are these from now on, and
        nothing else changes. Raise `ControllerError` or `ParameterError` to refuse the change.
        """
        self._parameters = parameters

    def on_activate(self) -> None:
        """Get ready for the first update; `commands` and `states` are loaned from now on."""

    @abstractmethod
    def update(self, time_s: float, period_s: float) -> ReturnType:
        """Compute one cycle: read `states`, write `commands`. Must not block.

        Args:
            time_s: the manager's time (simulation time in a simulation).
            period_s: time since this controller's last update; nominal in the first one.
        """

    def on_deactivate(self) -> None:
        """Leave the commands safe; the interfaces are taken away afterwards."""

    def on_cleanup(self) -> None:
        """Forget the parameters."""
        self._parameters = None

    def on_shutdown(self) -> None:
        """Let go of everything; nothing is called afterwards."""

    def assign_interfaces(self, commands: LoanedInterfaces, states: LoanedInterfaces) -> None:
        """Loan the interfaces; called by the manager before `on_activate`."""
        self.commands = commands
        self.states = states

    def release_interfaces(self) -> None:
        """Take the interfaces back; called by the manager after `on_deactivate`."""
        self.commands = _NOTHING
        self.states = _NOTHING
