"""Selects the controllers that run, and keeps active ones from running while nothing obeys them.

The manual's page on life cycles has the table of all states, which a test walks.
"""

import logging
from collections.abc import Mapping, Sequence

from arm_control.hardware.command_limits import CommandLimiter
from arm_control.hardware.driver import StoppableHardware
from arm_control.hardware.resource_manager import ResourceManager
from arm_control.lifecycle import LifecycleState
from arm_control.loop.supervision import failure_of
from arm_control.manager.controller_switcher import ControllerSwitcher, manager_option
from arm_control.manager.loaded_controllers import LoadedControllers, ManagedController

EMERGENCY = ""
"""Stands for the emergency stop where others are halted by a component, which has a name."""
REASON = "emergency stop"
LATCHED = "the emergency stop is latched: release it first, for example with arm stop --release"

logger = logging.getLogger("controller_manager")


class RunningControllers:
    """The active controllers in order of execution, some of which are halted. Loop thread only.

    A controller is halted by an emergency stop, or while its hardware is not active: it stays
    active and keeps its interfaces, but it is not updated, its goals are aborted and new ones
    refused with the reason. What it does at a deactivation and at an activation happens when it is
    halted and when it goes on.

    In an emergency stop, hardware that can stop by itself does so; any other gets commands that
    hold.

    Attributes:
        running: those with commands, and those whose exported states they read; not the halted
            ones.
        broadcasting: those that only read states.
        is_stopped: whether the emergency stop holds everything, until it is released.
    """

    def __init__(
        self,
        loaded: LoadedControllers,
        resources: ResourceManager,
        switcher: ControllerSwitcher,
        limiter: CommandLimiter | None,
        manager_name: str,
    ) -> None:
        self.running: tuple[ManagedController, ...] = ()
        self.broadcasting: tuple[ManagedController, ...] = ()
        self.is_stopped = False
        self._loaded = loaded
        self._resources = resources
        self._switcher = switcher
        self._limiter = limiter
        self._option = manager_option(manager_name)
        self._held = resources.commands.copy()

    def refresh(self) -> None:
        """Find them again; called after everything that may change them."""
        halted = {c.name for c in self._loaded.values() if c.is_halted}
        commanding = self._find_commanding()
        if failed := self._halt_or_go_on(commanding):
            self._switcher.deactivate(self._loaded.with_preceding(failed))
            commanding = self._find_commanding()
        if self.is_stopped:
            self.hold_here()
        self.running = tuple(c for c in commanding if not c.is_halted)
        if self._limiter is not None:
            self._limiter.claimed({name for c in self._loaded.active() for name in c.commands})
            resumed = [c for c in self.running if c.name in halted]
            self._limiter.forget({name for c in resumed for name in c.commands})

    def set_emergency_stop(self, engaged: bool) -> None:
        """Engage or release the emergency stop; the caller refreshes afterwards."""
        if engaged:
            logger.warning("emergency stop: everything brakes and holds until it is released")
        self.is_stopped = engaged
        for component in self._resources.components.values():
            hardware = component.hardware
            if isinstance(hardware, StoppableHardware):
                reason = failure_of(
                    lambda hardware=hardware: hardware.set_emergency_stop(engaged),
                    f"set_emergency_stop of hardware component '{component.name}'",
                )
                if reason:
                    logger.error("%s", reason)
        if not engaged:
            logger.warning(
                "emergency stop released: controllers continue from the present positions"
            )

    def hold_here(self) -> None:
        """Hold every joint where it is now, in each cycle of the emergency stop from now on."""
        self._held = self._resources.holding_commands()

    def hold(self) -> None:
        """Write the commands that hold; called in each cycle of the emergency stop."""
        self._resources.commands[:] = self._held

    def _find_commanding(self) -> tuple[ManagedController, ...]:
        active = [c for c in self._loaded.in_order() if c.is_active]
        commanding = self._loaded.with_read(c for c in active if c.commands)
        self.broadcasting = tuple(c for c in active if c not in commanding)
        return commanding

    def _halt_or_go_on(self, controllers: Sequence[ManagedController]) -> list[ManagedController]:
        """Halt what nothing obeys any more, and let go on what is obeyed again.

        The controllers are the active ones that command, in order of execution.

        Returns:
            Those that cannot go on.
        """
        blocked = self._blocked(controllers)
        halted: dict[str, list[str]] = {}
        for managed in self._loaded.from_below(controllers[::-1])[::-1]:
            blocker = blocked.get(managed.name)
            if blocker is None:
                continue
            if managed.is_halted:
                managed.controller.halted_by = self._reason(blocker)
                continue
            managed.halt(self._reason(blocker))
            # Nobody else writes these until it goes on, not even to hardware that still obeys.
            self._resources.hold(managed.commands)
            halted.setdefault(blocker, []).append(managed.name)
        resuming = [c for c in controllers if c.is_halted and c.name not in blocked]
        self._log(halted, [c.name for c in resuming if c.controller.halted_by != REASON])
        return [c for c in self._loaded.from_below(resuming) if not c.go_on()]

    def _blocked(self, controllers: Sequence[ManagedController]) -> dict[str, str]:
        """Return what keeps controllers from running: a component, or EMERGENCY."""
        if self.is_stopped:
            return dict.fromkeys((c.name for c in controllers), EMERGENCY)
        blocked: dict[str, str] = {}
        for name, component in self._resources.components.items():
            if component.state is LifecycleState.ACTIVE:
                continue
            users = [
                c for c in controllers if name in self._resources.components_of((), c.commands)
            ]
            blocked |= {c.name: name for c in self._loaded.with_commands(users)}
        return blocked

    def _reason(self, blocker: str) -> str:
        if blocker == EMERGENCY:
            return REASON
        state = self._resources.components[blocker].state
        return f"hardware component '{blocker}' is {state.label}"

    def _log(self, halted: Mapping[str, Sequence[str]], resuming: Sequence[str]) -> None:
        """Log what hardware has halted, and what continues; the emergency stop tells by itself."""
        for blocker, names in halted.items():
            if blocker != EMERGENCY:
                logger.warning(
                    "controllers [ %s ] hold and take no commands: %s; activate it with: "
                    "arm control set_hardware_component_state %s active%s",
                    " ".join(names),
                    self._reason(blocker),
                    blocker,
                    self._option,
                )
        if resuming:
            logger.info(
                "controllers [ %s ] continue from the present positions", " ".join(resuming)
            )
