"""Runs the life-cycle transitions of a controller, and claims and loans its interfaces."""

import logging
from collections import Counter
from collections.abc import Callable

from arm_control.hardware.resource_manager import ResourceManager
from arm_control.lifecycle import LifecycleState, Transition
from arm_control.loop.supervision import failure_of
from arm_control.manager.managed_controller import ManagedController

logger = logging.getLogger("controller_manager")

TransitionListener = Callable[[str, Transition, LifecycleState, LifecycleState], None]
"""Is told of an attempted transition: controller, transition, state before, state after."""


class ControllerLifecycle:
    """The transitions of controllers; each method returns why it failed, or an empty string.

    The manager checks that a transition is allowed from the current state. Loop thread only.
    """

    def __init__(self, resources: ResourceManager, listener: TransitionListener) -> None:
        self._resources = resources
        self._listener = listener

    def configure(self, managed: ManagedController, parameters: object) -> str:
        """Pass the parameters to the controller and find its interfaces."""
        reason = self._run(
            managed, Transition.CONFIGURE, lambda: managed.controller.on_configure(parameters)
        )
        if not reason:
            reason = self._export(managed) or self.resolve(managed)
            if reason:
                failure_of(managed.controller.on_cleanup, f"on_cleanup of '{managed.name}'")
                self._resources.exported.remove(managed.name)
        if not reason:
            managed.controller.configured_with = parameters
        return self._arrive(managed, Transition.CONFIGURE, reason)

    def resolve(self, managed: ManagedController) -> str:
        """Find the interfaces that the controller requests among those that exist now."""
        reason = failure_of(
            lambda: managed.resolve_interfaces(self._resources),
            f"the interface configuration of controller '{managed.name}'",
        )
        reason = reason or _repeated_names("command", managed.commands)
        reason = reason or _repeated_names("state", managed.states)
        if reason:
            managed.forget_interfaces()
        return reason

    def clean_up(self, managed: ManagedController) -> str:
        """Clean up the controller; it stays inactive if its `on_cleanup` fails."""
        reason = self._run(managed, Transition.CLEANUP, managed.controller.on_cleanup)
        if not reason:
            self._forget(managed)
        return self._arrive(managed, Transition.CLEANUP, reason)

    def activate(self, managed: ManagedController) -> str:
        """Loan and claim the interfaces, then activate the controller."""
        reason = self._run(managed, Transition.ACTIVATE, lambda: self._lend(managed))
        reason = reason or self._run(managed, Transition.ACTIVATE, managed.controller.on_activate)
        if reason:
            self._take_interfaces(managed)
        return self._arrive(managed, Transition.ACTIVATE, reason)

    def deactivate(self, managed: ManagedController) -> str:
        """Deactivate the controller and release its interfaces, even if it fails.

        A controller whose `on_deactivate` fails is cleaned up, because it may not start again. A
        controller that an emergency stop has halted has done this already.
        """
        reason = ""
        if managed.is_halted:
            managed.controller.halted_by = ""
        else:
            reason = self._run(managed, Transition.DEACTIVATE, managed.controller.on_deactivate)
        self._take_interfaces(managed)
        self._arrive(managed, Transition.DEACTIVATE, "")
        if reason:
            self.clean_up(managed)
        return reason

    def shut_down(self, managed: ManagedController) -> str:
        """Finalize the controller, even if its `on_shutdown` fails."""
        reason = self._run(managed, Transition.SHUTDOWN, managed.controller.on_shutdown)
        self._forget(managed)
        self._arrive(managed, Transition.SHUTDOWN, "")
        return reason

    def _lend(self, managed: ManagedController) -> None:
        managed.controller.assign_interfaces(
            self._resources.loan_commands(managed.commands),
            self._resources.loan_states(managed.states),
        )
        self._resources.claim(managed.name, managed.commands)
        managed.restart_cadence()
        managed.forget_references()

    def _forget(self, managed: ManagedController) -> None:
        managed.forget_interfaces()
        self._resources.exported.remove(managed.name)

    def _export(self, managed: ManagedController) -> str:
        return failure_of(
            lambda: self._resources.exported.add(managed),
            f"the interface export of controller '{managed.name}'",
        )

    def _run(
        self, managed: ManagedController, transition: Transition, step: Callable[[], None]
    ) -> str:
        reason = failure_of(step, f"on_{transition.label} of controller '{managed.name}'")
        if reason:
            logger.error("controller '%s' failed to %s: %s", managed.name, transition.label, reason)
        return reason

    def _arrive(self, managed: ManagedController, transition: Transition, reason: str) -> str:
        start = managed.state
        if not reason:
            managed.state = transition.goal
        self._listener(managed.name, transition, start, managed.state)
        return reason

    def _take_interfaces(self, managed: ManagedController) -> None:
        managed.controller.release_interfaces()
        self._resources.release(managed.name)


def _repeated_names(kind: str, names: tuple[str, ...]) -> str:
    repeated = sorted(name for name, count in Counter(names).items() if count > 1)
    return f"it requests {kind} interface {', '.join(repeated)} more than once" if repeated else ""
