"""How fast trajectory time runs."""

import logging

from arm_control.joint_trajectory.motion import LARGEST
from arm_control.joint_trajectory.parameters import SpeedScalingParameters


class SpeedScaling:
    """The factor between trajectory time and the controller's time.

    It is what a client asks for, or, where hardware has a state interface for it, what the
    hardware says; then a client's wish goes to the hardware, if that has a command interface.

    Attributes:
        factor: in force; 0 makes trajectories stand still. Loop thread.
        requested: what a client asked for last.
    """

    def __init__(self, parameters: SpeedScalingParameters, logger: logging.Logger) -> None:
        """Begin with the initial factor."""
        self.factor = self.requested = parameters.initial_scaling_factor
        self._parameters = parameters
        self._logger = logger

    @property
    def command_names(self) -> tuple[str, ...]:
        """The command interface to hand the wish to, if there is one."""
        return tuple(filter(None, (self._parameters.command_interface,)))

    @property
    def state_names(self) -> tuple[str, ...]:
        """The state interface that tells the factor, if there is one."""
        return tuple(filter(None, (self._parameters.state_interface,)))

    def request(self, factor: float) -> bool:
        """Ask for a factor; any thread. Return whether it was taken."""
        if not _is_factor(factor):
            self._logger.warning(
                "Scaling factor has to be greater or equal to 0.0 - Ignoring input! (%g)", factor
            )
            return False
        if self.state_names and not self.command_names:
            self._logger.warning(
                "the hardware tells the speed scaling factor and takes none: %g is overwritten by "
                "what it says; see the parameter speed_scaling.command_interface",
                factor,
            )
        self.requested = factor
        return True

    def refresh(self, measured: float | None) -> None:
        """Bring the requested factor into force, or the one that the hardware measured."""
        factor = self.requested if measured is None else measured
        # Hardware that is still starting has no valid factor; what there is stays in force.
        if _is_factor(factor):
            self.factor = factor


def _is_factor(value: float) -> bool:
    return 0.0 <= value <= LARGEST
