"""Turns set-points into commands."""

import numpy as np
from numpy.typing import NDArray

from arm_control.controllers.joint_trajectory.configuration import Configuration
from arm_control.controllers.joint_trajectory.plans import EFFORT, POSITION, VELOCITY
from arm_control.controllers.joint_trajectory.state import ControllerState
from arm_control.controllers.loaned_interfaces import LoanedInterfaces
from arm_control.controllers.pid import Pid


class Commander:
    """Computes and writes the commands of one activation. Loop thread only.

    Position, velocity and acceleration commands are the set-points at the end of the period, when
    they have taken effect; effort commands are the present set-points. If the only command is a
    velocity or an effort, a PID controller computes it from the errors.
    """

    def __init__(self, configuration: Configuration, commands: LoanedInterfaces) -> None:
        """Take the loaned command interfaces.

        Args:
            configuration: configuration of the controller.
            commands: its command interfaces, and possibly one for the speed scaling factor.
        """
        interfaces = configuration.interfaces
        self._commands = commands
        self._interfaces = interfaces
        self._pid = Pid(configuration.gains) if configuration.gains else None
        self._feedforward = configuration.feedforward
        rows = [row for row in interfaces.command_rows if row != EFFORT]
        self._forwarded_rows = slice(rows[0], rows[-1] + 1) if rows else slice(0, 0)
        self._commands_effort = EFFORT in interfaces.command_rows
        self._passive = np.setdiff1d(np.arange(len(interfaces.joints)), interfaces.commanded)
        self._commands_scaling = len(commands) > len(interfaces.command_names)

    def reconfigure(self, configuration: Configuration) -> None:
        """Apply changed gains."""
        self._feedforward = configuration.feedforward
        if self._pid is not None:
            self._pid.set_gains(configuration.gains)

    def save_state(self) -> NDArray[np.float64] | None:
        """Return the integrals of the PID controller, shape (k,), if there is one."""
        return None if self._pid is None else self._pid.save_state()

    def load_state(self, state: NDArray[np.float64] | None) -> None:
        """Set the integrals."""
        if self._pid is not None and state is not None:
            self._pid.load_state(state)

    def last_positions(self) -> NDArray[np.float64] | None:
        """Return the last commanded positions, shape (k,) for k commanded joints.

        Returns:
            None if positions are not commanded, or if any command is unknown.
        """
        names = self._interfaces.command_names
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
        """Compute `state.output` and write it.

        Args:
            state: the current state, including its errors.
            upcoming: set-point at the end of the period, shape (4, n).
            period_s: length of the period.
            requested_scaling: speed scaling factor, for hardware that supports it.
        """
        output = state.output
        if self._pid is not None:
            output[0] = self._pid.update(state.error[POSITION], state.error[VELOCITY], period_s)
            output[0] += self._feedforward * upcoming[VELOCITY]
            if self._commands_effort:
                output[0] += state.reference[EFFORT]
        else:
            forwarded = upcoming[self._forwarded_rows]
            output[: len(forwarded)] = forwarded
            if self._commands_effort:
                output[-1] = state.reference[EFFORT]
        if len(self._passive):
            output[:, self._passive] = np.nan
        values = output.reshape(-1)[self._interfaces.command_index]
        if self._commands_scaling:
            values = np.append(values, requested_scaling)
        self._commands.write(values)

    def write_safe_commands(self) -> None:
        """Leave position commands unchanged, and set all others to 0."""
        values = self._commands.read().copy()
        for i, name in enumerate(self._interfaces.command_names):
            if not name.endswith("/position"):
                values[i] = 0.0
        self._commands.write(values)
