"""What the manager asks of a hardware component, simulated or real."""

from collections.abc import Sequence
from enum import Enum
from typing import Protocol

import numpy as np
from numpy.typing import NDArray

from arm_control.hardware_info import HardwareInfo


class HardwareReturn(Enum):
    """Outcome of one read or write."""

    OK = "ok"
    ERROR = "error"
    """The component failed: it is taken down, and the controllers that use it are stopped."""
    DEACTIVATE = "deactivate"
    """The component asks to be deactivated: controllers that command it are stopped.

    One that is not active is so already; one whose `on_deactivate` fails is taken down.
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
        """Keep these views for good; called once, before anything else.

        Args:
            states: shape (len(state_interfaces),), written by `read`; NaN until then.
            commands: shape (len(command_interfaces),), taken by `write`; NaN where no controller
                has commanded anything yet.
        """
        ...

    def on_configure(self) -> bool:
        """Open communication; states may be read from now on."""
        ...

    def on_activate(self) -> bool:
        """Power up; commands are taken from now on."""
        ...

    def on_deactivate(self) -> bool:
        """Stop taking commands; controllers keep their claims, and go on after `on_activate`."""
        ...

    def on_cleanup(self) -> bool:
        """Undo `on_configure`; after a failed read or write, from whatever state it was in."""
        ...

    def on_shutdown(self) -> bool:
        """Let go of everything, whatever the state; nothing is called afterwards."""
        ...

    def prepare_command_mode_switch(self, start: Sequence[str], stop: Sequence[str]) -> bool:
        """Say whether these command interfaces of this component may be claimed and released.

        Changes nothing: the switch may still be called off.
        """
        ...

    def perform_command_mode_switch(self, start: Sequence[str], stop: Sequence[str]) -> bool:
        """Switch over to the command interfaces in `start`, away from those in `stop`.

        An interface in both passes from one controller to another, or is claimed anew.
        """
        ...

    def read(self, time_s: float, period_s: float) -> HardwareReturn:
        """Fill the states.

        Args:
            time_s: the manager's time; 0 in the read at the start.
            period_s: time since the last read, more than 0; nominal in the first one.
        """
        ...

    def write(self, time_s: float, period_s: float) -> HardwareReturn:
        """Take the commands.

        Args:
            time_s: the manager's time.
            period_s: time since the last write, more than 0; nominal in the first one.
        """
        ...
