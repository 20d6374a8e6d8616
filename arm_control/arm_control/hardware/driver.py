"""The interface of hardware drivers, and a base class that holds their arrays."""

import logging
from abc import ABC, abstractmethod
from collections.abc import Mapping, Sequence
from dataclasses import field
from enum import Enum
from typing import Protocol, runtime_checkable

import numpy as np
from numpy.typing import NDArray

from arm_control.errors import HardwareInfoError
from arm_control.hardware.info import HardwareInfo
from arm_node.frozen import frozen


class HardwareReturn(Enum):
    """Outcome of one read or write."""

    OK = "ok"
    ERROR = "error"
    """The component failed: the manager shuts it off and stops the controllers that use it."""
    DEACTIVATE = "deactivate"
    """The component asks to be deactivated: the manager stops the controllers that command it.

    It has no effect on a component that is not active. If `on_deactivate` fails, the component is
    handled as if it had returned ERROR.
    """


class Hardware(Protocol):
    """A hardware component: joints, sensors and GPIOs behind one driver.

    The manager calls every method from the loop thread. A life-cycle method returns whether it
    succeeded; an exception counts as a failure and its message is logged.

    Attributes:
        info: what the robot description says about the component.
        state_interfaces: full names such as 'j0/position', in the order of the states array.
        command_interfaces: full names, in the order of the commands array.
    """

    info: HardwareInfo
    state_interfaces: tuple[str, ...]
    command_interfaces: tuple[str, ...]

    def bind(self, states: NDArray[np.float64], commands: NDArray[np.float64]) -> None:
        """Store these views; called once, before any other method.

        Args:
            states: shape (len(state_interfaces),), written by `read`; NaN until then.
            commands: shape (len(command_interfaces),), sent by `write`; NaN for an interface that
                no controller has commanded yet.
        """
        ...

    def on_configure(self) -> bool:
        """Open communication; `read` is called from now on."""
        ...

    def on_activate(self) -> bool:
        """Power up; `write` is called from now on.

        Interfaces may have been claimed before, and still are. Those that have been commanded
        before have commands now that hold the joints where they are.
        """
        ...

    def on_deactivate(self) -> bool:
        """Stop sending commands; keep the command modes, which count again after `on_activate`.

        Controllers keep their claims. They are not updated until the component is active again.
        """
        ...

    def on_cleanup(self) -> bool:
        """Undo `on_configure`; after a failed read or write it is called in any state.

        No controller has claimed an interface any more, and all commands are NaN afterwards.
        """
        ...

    def on_shutdown(self) -> bool:
        """Release everything, in any state; no method is called afterwards."""
        ...

    def prepare_command_mode_switch(self, start: Sequence[str], stop: Sequence[str]) -> bool:
        """Return whether these command interfaces of this component may be claimed and released.

        It must not change anything: the switch may still be cancelled.
        """
        ...

    def perform_command_mode_switch(self, start: Sequence[str], stop: Sequence[str]) -> bool:
        """Switch to the command interfaces in `start` and away from those in `stop`.

        An interface in both passes from one controller to another, or is claimed again.
        """
        ...

    def read(self, time_s: float, period_s: float) -> HardwareReturn:
        """Read the sensors into `states`.

        Args:
            time_s: the manager's time; 0 for the read at start-up.
            period_s: time since the last read, above 0; the nominal period for the first one.
        """
        ...

    def write(self, time_s: float, period_s: float) -> HardwareReturn:
        """Send the commands.

        Args:
            time_s: the manager's time.
            period_s: time since the last write, above 0; the nominal period for the first one.
        """
        ...


@runtime_checkable
class StoppableHardware(Protocol):
    """Hardware that comes to rest by its own means: a driver may have this method."""

    def set_emergency_stop(self, engaged: bool) -> None:
        """Brake and hold, whatever the commands are; or obey the commands again.

        Without this method, the manager commands zero velocity and effort and the measured
        positions during an emergency stop. At a release, a driver with this method sets each
        command to the value that keeps its joint in place.
        """
        ...


@runtime_checkable
class SingleModeHardware(Protocol):
    """Hardware whose joints obey one kind of command at a time: a driver may have this attribute.

    The manager refuses a switch after which two controllers would command one joint by these
    interfaces, because only one of them would be obeyed. One controller may claim several.

    Attributes:
        modes: the kinds of command interfaces of which a joint obeys one, such as 'position'.
    """

    modes: tuple[str, ...]


@frozen
class HardwareHealth:
    """What a driver knows about its own health.

    Attributes:
        problem: sentences for the user; empty if there is none.
        values: figures and states by name, for those who search a fault.
    """

    problem: str = ""
    values: Mapping[str, str] = field(default_factory=dict)


@runtime_checkable
class SelfDiagnosing(Protocol):
    """Hardware that knows its own faults: a driver may have this method."""

    def health(self) -> HardwareHealth:
        """Return its health, for /diagnostics; any thread, without waiting."""
        ...


@runtime_checkable
class Resettable(Protocol):
    """A driver of simulated hardware that can start over."""

    def reset(self) -> None:
        """Set each command to the value that keeps its joint in place, and fill the states.

        Called after the simulation was reset, whatever the component's life-cycle state.
        """
        ...


class SystemInterface(ABC):
    """A hardware component with the interfaces that the robot description lists for it.

    A driver implements `read` and `write`, and the life-cycle methods that it needs; the defaults
    of the others do nothing and succeed. `arm_control.Hardware` says when each is called; all are
    called on the loop thread.

    Attributes:
        info: what the robot description says about the component.
        logger: named after the component.
        states: one value for each of `state_interfaces`, set by `read`.
        commands: one value for each of `command_interfaces`; NaN until it is commanded.
    """

    def __init__(self, info: HardwareInfo) -> None:
        """Set up the interfaces; raise `HardwareInfoError` if the description cannot be used."""
        self.info = info
        self.logger = logging.getLogger(info.name)
        self.state_interfaces = info.state_interface_names
        self.command_interfaces = info.command_interface_names
        self.states: NDArray[np.float64] = np.full(len(self.state_interfaces), np.nan)
        self.commands: NDArray[np.float64] = np.full(len(self.command_interfaces), np.nan)

    def bind(self, states: NDArray[np.float64], commands: NDArray[np.float64]) -> None:
        """Store the manager's views."""
        self.states, self.commands = states, commands

    def get_state(self, name: str) -> float:
        """Return the value of a state interface such as 'j0/position'."""
        return float(self.states[_index(self.state_interfaces, name, self.info)])

    def set_state(self, name: str, value: float) -> None:
        """Set a state interface."""
        self.states[_index(self.state_interfaces, name, self.info)] = value

    def get_command(self, name: str) -> float:
        """Return the value of a command interface; NaN until it is commanded."""
        return float(self.commands[_index(self.command_interfaces, name, self.info)])

    def on_configure(self) -> bool:
        """Open communication."""
        return True

    def on_activate(self) -> bool:
        """Power up."""
        return True

    def on_deactivate(self) -> bool:
        """Power down."""
        return True

    def on_cleanup(self) -> bool:
        """Close communication, also after a failure."""
        return True

    def on_shutdown(self) -> bool:
        """Release everything; by default this calls `on_deactivate` and `on_cleanup`."""
        stopped = self.on_deactivate()
        return self.on_cleanup() and stopped

    def prepare_command_mode_switch(self, start: Sequence[str], stop: Sequence[str]) -> bool:
        """Accept every switch."""
        return True

    def perform_command_mode_switch(self, start: Sequence[str], stop: Sequence[str]) -> bool:
        """Do nothing: this driver has no command modes to switch."""
        return True

    @abstractmethod
    def read(self, time_s: float, period_s: float) -> HardwareReturn:
        """Read the sensors into `states`; must return well within the period."""

    @abstractmethod
    def write(self, time_s: float, period_s: float) -> HardwareReturn:
        """Send the commands; must return well within the period."""


def _index(names: Sequence[str], name: str, info: HardwareInfo) -> int:
    try:
        return names.index(name)
    except ValueError:
        raise HardwareInfoError(
            f"hardware component '{info.name}' has no interface '{name}'; "
            f"it has {', '.join(names) or 'none'}"
        ) from None
