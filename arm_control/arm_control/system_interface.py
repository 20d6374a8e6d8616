"""A base for drivers: all of `Hardware` but how to read and how to write."""

import logging
from abc import ABC, abstractmethod
from collections.abc import Sequence

import numpy as np
from numpy.typing import NDArray

from arm_control.errors import HardwareInfoError
from arm_control.hardware import HardwareReturn
from arm_control.hardware_info import HardwareInfo


class SystemInterface(ABC):
    """A hardware component with the interfaces that the robot description lists for it.

    A driver writes `read` and `write`, and whichever of the life-cycle methods it needs; the
    others succeed and do nothing. See `arm_control.Hardware` for when each is called, on the loop
    thread all of them.

    Attributes:
        info: what the robot description says about the component.
        logger: named after the component.
        states: one value for each of `state_interfaces`; `read` fills them in.
        commands: one value for each of `command_interfaces`; NaN where nothing was commanded yet.
    """

    def __init__(self, info: HardwareInfo) -> None:
        """Lay out the interfaces; raise `HardwareInfoError` where the description is of no use."""
        self.info = info
        self.logger = logging.getLogger(info.name)
        self.state_interfaces = info.state_interface_names
        self.command_interfaces = info.command_interface_names
        self.states: NDArray[np.float64] = np.full(len(self.state_interfaces), np.nan)
        self.commands: NDArray[np.float64] = np.full(len(self.command_interfaces), np.nan)

    def bind(self, states: NDArray[np.float64], commands: NDArray[np.float64]) -> None:
        """Keep the manager's views."""
        self.states, self.commands = states, commands

    def get_state(self, name: str) -> float:
        """Return the value of a state interface, 'j0/position'."""
        return float(self.states[_index(self.state_interfaces, name, self.info)])

    def set_state(self, name: str, value: float) -> None:
        """Set a state interface."""
        self.states[_index(self.state_interfaces, name, self.info)] = value

    def get_command(self, name: str) -> float:
        """Return the value of a command interface; NaN where nothing was commanded yet."""
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
        """Close communication, after a failure too."""
        return True

    def on_shutdown(self) -> bool:
        """Let go of everything: by default what `on_deactivate` and `on_cleanup` let go of."""
        stopped = self.on_deactivate()
        return self.on_cleanup() and stopped

    def prepare_command_mode_switch(self, start: Sequence[str], stop: Sequence[str]) -> bool:
        """Agree to whatever controllers claim."""
        return True

    def perform_command_mode_switch(self, start: Sequence[str], stop: Sequence[str]) -> bool:
        """Need nothing to be switched over."""
        return True

    @abstractmethod
    def read(self, time_s: float, period_s: float) -> HardwareReturn:
        """Fill the states; must not wait for longer than a part of the period."""

    @abstractmethod
    def write(self, time_s: float, period_s: float) -> HardwareReturn:
        """Take the commands; must not wait for longer than a part of the period."""


def _index(names: Sequence[str], name: str, info: HardwareInfo) -> int:
    try:
        return names.index(name)
    except ValueError:
        raise HardwareInfoError(
            f"hardware component '{info.name}' has no interface '{name}'; "
            f"it has {', '.join(names) or 'none'}"
        ) from None
