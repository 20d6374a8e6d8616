"""What is written to the command interfaces: the joints' commands and the speed scaling factor."""

import logging

import numpy as np

from arm_control.controllers.joint_trajectory.configuration import Configuration
from arm_control.controllers.joint_trajectory.parameters import SpeedScalingParameters
from arm_control.controllers.joint_trajectory.profiles import (
    EFFORT,
    LARGEST,
    POSITION,
    VELOCITY,
    Array,
)
from arm_control.controllers.joint_trajectory.state import ControllerState
from arm_control.controllers.loaned_interfaces import LoanedInterfaces
from arm_control.controllers.pid import Pid


class SpeedScaling:
    """The factor between trajectory time and the controller's time.

    A client requests it. If the hardware has a state interface for it, the hardware sets it; then
    the request goes to the hardware's command interface, if there is one.

    Attributes:
        factor: the current factor; 0 stops trajectories. Loop thread.
        requested: the factor that a client requested last.
    """

    def __init__(self, parameters: SpeedScalingParameters, logger: logging.Logger) -> None:
        """Start with the initial factor."""
        self.factor = self.requested = parameters.initial_scaling_factor
        self._parameters = parameters
        self._logger = logger

    @property
    def command_names(self) -> tuple[str, ...]:
        """The command interface for the requested factor, if there is one."""
        return tuple(filter(None, (self._parameters.command_interface,)))

    @property
    def state_names(self) -> tuple[str, ...]:
        """The state interface of the factor, if there is one."""
        return tuple(filter(None, (self._parameters.state_interface,)))

    def request(self, factor: float) -> bool:
        """Request a factor; any thread. Return whether it was accepted."""
        if not _is_factor(factor):
            self._logger.warning(
                "Scaling factor has to be greater or equal to 0.0 - Ignoring input! (%g)", factor
            )
            return False
        if self.state_names and not self.command_names:
            self._logger.warning(
                "the hardware sets the speed scaling factor, so the requested %g has no effect; "
                "see the parameter speed_scaling.command_interface",
                factor,
            )
        self.requested = factor
        return True

    def save_state(self) -> tuple[float, float]:
        """Return the factor and the requested one."""
        return self.factor, self.requested

    def load_state(self, state: tuple[float, float]) -> None:
        """Set the factor and the requested one."""
        self.factor, self.requested = state

    def refresh(self, measured: float | None) -> None:
        """Apply the requested factor, or the one that the hardware reports."""
        factor = self.requested if measured is None else measured
        # Hardware that is still starting reports no valid factor; the old one stays.
        if _is_factor(factor):
            self.factor = factor


def _is_factor(value: float) -> bool:
    return 0.0 <= value <= LARGEST


class CommandWriter:
    """Computes and writes the commands of one activation. Loop thread only.

    Position, velocity and acceleration commands are the set-points at the end of the period, when
    they have taken effect; effort commands are the present set-points. If the only command is a
    velocity or an effort, a PID controller computes it from the errors.
    """

    def __init__(self, configuration: Configuration, commands: LoanedInterfaces) -> None:
        """Take the command interfaces; the last may be the one for the speed scaling factor."""
        interfaces = configuration.interfaces
        self._commands = commands
        self._interfaces = interfaces
        self._pid = Pid(configuration.gains) if configuration.gains else None
        self._feedforward = configuration.feedforward
        rows = [row for row in interfaces.command_rows if row != EFFORT]
        self._forwarded_rows = slice(rows[0], rows[-1] + 1) if rows else slice(0, 0)
        self._commands_effort = EFFORT in interfaces.command_rows
        self._passive = interfaces.passive
        self._commands_scaling = len(commands) > len(interfaces.command_names)

    def reconfigure(self, configuration: Configuration) -> None:
        """Apply changed gains."""
        self._feedforward = configuration.feedforward
        if self._pid is not None:
            self._pid.set_gains(configuration.gains)

    def save_state(self) -> Array | None:
        """Return the integrals of the PID controller, shape (k,), if there is one."""
        return None if self._pid is None else self._pid.save_state()

    def load_state(self, state: Array | None) -> None:
        """Set the integrals."""
        if self._pid is not None and state is not None:
            self._pid.load_state(state)

    def last_positions(self) -> Array | None:
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
        upcoming: Array,
        period_s: float,
        requested_scaling: float,
    ) -> None:
        """Compute `state.output` and write it.

        The state includes its errors. `upcoming` (4, n) is the set-point at the end of the period;
        the scaling is for hardware that supports it.
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
