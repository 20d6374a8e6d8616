"""Keeps active controllers from running while nothing obeys them.

The manual's page on life cycles has the table of all states, which a test walks.
"""

import logging
from collections.abc import Mapping, Sequence

from arm_control.hardware.resource_manager import ResourceManager
from arm_control.lifecycle import LifecycleState
from arm_control.manager.controller_chain import ControllerChain
from arm_control.manager.controller_switcher import manager_option
from arm_control.manager.emergency_stop import REASON, EmergencyStop
from arm_control.manager.managed_controller import ManagedController

EMERGENCY = ""
"""Stands for the emergency stop where others are halted by a component, which has a name."""

logger = logging.getLogger("controller_manager")


class ControllerHalts:
    """Halts controllers for an emergency stop, or while their hardware is not active.

    A halted controller stays active and keeps its interfaces, but it is not updated: its goals are
    aborted and new ones refused with the reason. What it does at a deactivation and at an
    activation happens when it is halted and when it goes on. Loop thread only.
    """

    def __init__(
        self,
        resources: ResourceManager,
        chain: ControllerChain,
        emergency: EmergencyStop,
        manager_name: str,
    ) -> None:
        """Refer to the manager's parts.

        Args:
            resources: the hardware.
            chain: knows which controllers command which.
            emergency: the emergency stop.
            manager_name: fully qualified name of the manager's node, for messages.
        """
        self._resources = resources
        self._chain = chain
        self._emergency = emergency
        self._option = manager_option(manager_name)

    def update(self, controllers: Sequence[ManagedController]) -> list[ManagedController]:
        """Halt what nothing obeys any more, and let go on what is obeyed again.

        Args:
            controllers: the active controllers that command, in order of execution.

        Returns:
            Those that cannot go on; the caller deactivates them.
        """
        blocked = self._blocked(controllers)
        halted: dict[str, list[str]] = {}
        for managed in self._chain.from_below(controllers[::-1])[::-1]:
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
        return [c for c in self._chain.from_below(resuming) if not c.go_on()]

    def _blocked(self, controllers: Sequence[ManagedController]) -> dict[str, str]:
        """Return what keeps controllers from running: a component, or EMERGENCY."""
        if self._emergency.is_engaged:
            return dict.fromkeys((c.name for c in controllers), EMERGENCY)
        blocked: dict[str, str] = {}
        for name, component in self._resources.components.items():
            if component.state is LifecycleState.ACTIVE:
                continue
            users = [
                c for c in controllers if name in self._resources.components_of((), c.commands)
            ]
            blocked |= {c.name: name for c in self._chain.with_commands(users)}
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
