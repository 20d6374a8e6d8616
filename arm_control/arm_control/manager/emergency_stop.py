"""The latched emergency stop of a controller manager."""

import logging
from collections.abc import Sequence

import numpy as np

from arm_control.hardware.driver import StoppableHardware
from arm_control.hardware.resource_manager import ResourceManager
from arm_control.loop.supervision import failure_of
from arm_control.manager.controller_chain import ControllerChain
from arm_control.manager.managed_controller import ManagedController

REASON = "emergency stop"
LATCHED = "the emergency stop is latched: release it first, for example with arm stop --release"
STAYS = ("position",)
"""Command interfaces for which the command that stops a joint is its own state, not 0."""
STOPS = ("velocity", "acceleration", "effort")

logger = logging.getLogger(__name__)


class EmergencyStop:
    """Brings everything that is commanded to rest, and keeps it there until it is released.

    Controllers with commands keep their interfaces, but they are not updated: their goals are
    aborted, and what they do at a deactivation and at an activation happens at the stop and at the
    release. Hardware that can stop by itself does so; any other gets commands that hold. Loop
    thread only.

    Attributes:
        is_engaged: whether everything is held.
    """

    def __init__(self, resources: ResourceManager, chain: ControllerChain) -> None:
        self.is_engaged = False
        self._resources = resources
        self._chain = chain
        self._held = resources.commands.copy()

    def engage(self, controllers: Sequence[ManagedController]) -> None:
        """Stop.

        Args:
            controllers: the active controllers that command, in order of execution.
        """
        logger.warning("emergency stop: everything brakes and holds until it is released")
        self.is_engaged = True
        self._tell_hardware()
        for managed in self._chain.from_below(controllers[::-1])[::-1]:
            managed.halt(REASON)
        self._held = self._holding_commands()

    def hold(self) -> None:
        """Write the commands that hold; called in each cycle of the stop."""
        self._resources.commands[:] = self._held

    def release(self, controllers: Sequence[ManagedController]) -> list[ManagedController]:
        """Let the controllers continue from rest; return those that cannot.

        Args:
            controllers: the active controllers that command, in order of execution.
        """
        self.is_engaged = False
        self._tell_hardware()
        logger.warning("emergency stop released: controllers continue from the present positions")
        return [c for c in self._chain.from_below(controllers) if not c.go_on()]

    def _tell_hardware(self) -> None:
        for component in self._resources.components.values():
            hardware = component.hardware
            if isinstance(hardware, StoppableHardware):
                reason = failure_of(
                    lambda hardware=hardware: hardware.set_emergency_stop(self.is_engaged),
                    f"set_emergency_stop of hardware component '{component.name}'",
                )
                if reason:
                    logger.error("%s", reason)

    def _holding_commands(self) -> np.ndarray:
        """Return the commands that hold each joint where it is, shape (n,)."""
        resources = self._resources
        states = dict(zip(resources.state_names, resources.states.tolist(), strict=True))
        held = resources.commands.copy()
        for index, name in enumerate(resources.command_names):
            kind = name.rpartition("/")[2]
            if kind in STOPS:
                held[index] = 0.0
            elif kind in STAYS and np.isfinite(states.get(name, np.nan)):
                held[index] = states[name]
        return held
