"""The `<gpio>`s of a `<ros2_control>` block: nothing moves, their states follow their commands."""

import math

import numpy as np
from numpy.typing import NDArray

from arm_control.hardware.info import HardwareInfo


class SimulatedGpios:
    """The interfaces of a component's GPIOs; loop thread.

    The state of a command's name follows the command. Other states, such as inputs, keep their
    initial values; without one they are NaN, as with mock_components/GenericSystem.

    Attributes:
        states: full names of the state interfaces, in the order of the block.
        commands: full names of the command interfaces, likewise.
        unset: the states that are NaN as long as the simulation runs.
    """

    def __init__(self, info: HardwareInfo) -> None:
        initial = {
            f"{gpio.name}/{interface.name}": interface.initial_value
            for gpio in info.gpios
            for interface in (*gpio.command_interfaces, *gpio.state_interfaces)
            if interface.initial_value is not None
        }
        self.states = tuple(f"{g.name}/{s.name}" for g in info.gpios for s in g.state_interfaces)
        self.commands = tuple(
            f"{g.name}/{c.name}" for g in info.gpios for c in g.command_interfaces
        )
        followed = [name for name in self.commands if name in self.states]
        self._from = np.array([self.commands.index(name) for name in followed], dtype=np.intp)
        self._to = np.array([self.states.index(name) for name in followed], dtype=np.intp)
        self._initial = [initial.get(name, math.nan) for name in self.states]
        self.unset = tuple(n for n in self.states if n not in initial and n not in followed)

    def start(self, states: NDArray[np.float64], commands: NDArray[np.float64]) -> None:
        """Set the states to their initial values; no command is given.

        Args:
            states: in the order of `states`.
            commands: in the order of `commands`.
        """
        states[:] = self._initial
        commands[:] = math.nan

    def follow(self, states: NDArray[np.float64], commands: NDArray[np.float64]) -> None:
        """Take changed commands; NaN is none. See `start` for the arguments."""
        values = commands[self._from]
        given = ~np.isnan(values)
        states[self._to[given]] = values[given]
