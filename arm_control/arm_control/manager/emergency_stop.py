"""The latched emergency stop of a controller manager."""

import logging

from arm_control.hardware.driver import StoppableHardware
from arm_control.hardware.resource_manager import ResourceManager
from arm_control.loop.supervision import failure_of

REASON = "emergency stop"
LATCHED = "the emergency stop is latched: release it first, for example with arm stop --release"

logger = logging.getLogger("controller_manager")


class EmergencyStop:
    """Brings everything that is commanded to rest, and keeps it there until it is released.

    Controllers with commands are halted, see `ControllerHalts`. Hardware that can stop by itself
    does so; any other gets commands that hold. Loop thread only.

    Attributes:
        is_engaged: whether everything is held.
    """

    def __init__(self, resources: ResourceManager) -> None:
        self.is_engaged = False
        self._resources = resources
        self._held = resources.commands.copy()

    def engage(self) -> None:
        """Stop; the caller halts the controllers, then calls `hold_here`."""
        logger.warning("emergency stop: everything brakes and holds until it is released")
        self.is_engaged = True
        self._tell_hardware()

    def hold_here(self) -> None:
        """Hold every joint where it is now, in each cycle from now on."""
        self._held = self._resources.holding_commands()

    def hold(self) -> None:
        """Write the commands that hold; called in each cycle of the stop."""
        self._resources.commands[:] = self._held

    def release(self) -> None:
        """Obey commands again; the caller lets the controllers continue."""
        self.is_engaged = False
        self._tell_hardware()
        logger.warning("emergency stop released: controllers continue from the present positions")

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
