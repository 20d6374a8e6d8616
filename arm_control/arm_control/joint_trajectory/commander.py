"""Turns the wanted motion into commands."""

import numpy as np
from numpy.typing import NDArray

from arm_control.joint_trajectory.configuration import Configuration
from arm_control.joint_trajectory.motion import EFFORT, POSITION, VELOCITY
from arm_control.joint_trajectory.pid import Pid
from arm_control.joint_trajectory.state import ControllerState
from arm_control.loaned_interfaces import LoanedInterfaces


class Commander:
    """Computes the commands of one activation, and writes them. Loop thread only.

    Positions, velocities and accelerations are handed through as they will be wanted when the
    command has taken effect, efforts as they are wanted now. Where the only command is a velocity
    or an effort, a PID controller computes it from the errors.
    """

    def __init__(self, configuration: Configuration, commands: LoanedInterfaces) -> None:
        """Take the interfaces over.

        Args:
            configuration: of the controller.
            commands: those of its wiring, and perhaps one for the speed scaling factor.
        """
        wiring = configuration.wiring
        self._commands = commands
        self._wiring = wiring
        self._pid = Pid(configuration.gains) if configuration.gains else None
        self._feedforward = configuration.feedforward
        rows = [row for row in wiring.command_rows if row != EFFORT]
        self._handed_through = slice(rows[0], rows[-1] + 1) if rows else slice(0, 0)
        self._commands_effort = EFFORT in wiring.command_rows
        self._passive = np.setdiff1d(np.arange(len(wiring.joints)), wiring.commanded)
        self._hands_scaling_on = len(commands) > len(wiring.command_names)

    def reconfigure(self, configuration: Configuration) -> None:
        """Take other gains."""
        self._feedforward = configuration.feedforward
        if self._pid is not None:
            self._pid.set_gains(configuration.gains)

    def last_positions(self) -> NDArray[np.float64] | None:
        """Return the positions commanded last, shape (k,) for k commanded joints.

        Returns:
            None where positions are not commanded, or any command is unknown.
        """
        names = self._wiring.command_names
        values = self._commands.read()[: len(names)]
        positions = [i for i, name in enumerate(names) if name.endswith("/position")]
        return values[positions] if positions and np.isfinite(values).all() else None

    def command(
        self,
        state: ControllerState,
        upcoming: NDArray[np.float64],
        period_s: float,
        requested_scaling: float,
    ) -> None:
        """Fill `state.output`, and write it.

        Args:
            state: the present state, its errors included.
            upcoming: motion wanted at the end of the period, shape (4, n).
            period_s: length of the period.
            requested_scaling: for hardware that takes a speed scaling factor.
        """
        output = state.output
        if self._pid is not None:
            output[0] = self._pid.update(state.error[POSITION], state.error[VELOCITY], period_s)
            output[0] += self._feedforward * upcoming[VELOCITY]
            if self._commands_effort:
                output[0] += state.reference[EFFORT]
        else:
            handed_through = upcoming[self._handed_through]
            output[: len(handed_through)] = handed_through
            if self._commands_effort:
                output[-1] = state.reference[EFFORT]
        if len(self._passive):
            output[:, self._passive] = np.nan
        values = output.reshape(-1)[self._wiring.command_index]
        if self._hands_scaling_on:
            values = np.append(values, requested_scaling)
        self._commands.write(values)

    def let_go(self) -> None:
        """Leave positions as they are, and everything else at zero."""
        values = self._commands.read().copy()
        for i, name in enumerate(self._wiring.command_names):
            if not name.endswith("/position"):
                values[i] = 0.0
        self._commands.write(values)
