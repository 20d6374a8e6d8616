"""Finds which controllers run in the next cycle."""

from collections.abc import Mapping

from arm_control.hardware.command_limits import CommandLimiter
from arm_control.manager.controller_chain import ControllerChain
from arm_control.manager.controller_switcher import ControllerSwitcher
from arm_control.manager.emergency_stop import EmergencyStop
from arm_control.manager.halts import ControllerHalts
from arm_control.manager.managed_controller import ManagedController


class ControllerSelection:
    """The active controllers, in order of execution. Loop thread only.

    Attributes:
        running: those with commands, and those whose exported states they read; not the halted
            ones.
        broadcasting: those that only read states.
    """

    def __init__(
        self,
        controllers: Mapping[str, ManagedController],
        chain: ControllerChain,
        switcher: ControllerSwitcher,
        halts: ControllerHalts,
        emergency: EmergencyStop,
        limiter: CommandLimiter | None,
    ) -> None:
        """Refer to the manager's parts.

        Args:
            controllers: by name; the manager adds and removes some later.
            chain: the order of the controllers.
            switcher: deactivates those that cannot go on.
            halts: keeps some from running.
            emergency: the emergency stop.
            limiter: clamps the commands.
        """
        self.running: tuple[ManagedController, ...] = ()
        self.broadcasting: tuple[ManagedController, ...] = ()
        self._controllers = controllers
        self._chain = chain
        self._switcher = switcher
        self._halts = halts
        self._emergency = emergency
        self._limiter = limiter

    def refresh(self) -> None:
        """Find them again; called after everything that may change them."""
        halted = {c.name for c in self._controllers.values() if c.is_halted}
        commanding = self._find_commanding()
        if failed := self._halts.update(commanding):
            self._switcher.deactivate(self._chain.with_preceding(failed))
            commanding = self._find_commanding()
        if self._emergency.is_engaged:
            self._emergency.hold_here()
        self.running = tuple(c for c in commanding if not c.is_halted)
        if self._limiter is not None:
            active = [c for c in self._controllers.values() if c.is_active]
            self._limiter.claimed({name for c in active for name in c.commands})
            resumed = [c for c in self.running if c.name in halted]
            self._limiter.forget({name for c in resumed for name in c.commands})

    def _find_commanding(self) -> tuple[ManagedController, ...]:
        active = [c for c in self._chain.in_order() if c.is_active]
        commanding = self._chain.with_read(c for c in active if c.commands)
        self.broadcasting = tuple(c for c in active if c not in commanding)
        return commanding
