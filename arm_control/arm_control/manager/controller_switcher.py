"""Takes controllers through their life cycle, one by one or several in one switch."""

import logging
from collections import Counter
from collections.abc import Callable, Iterable, Sequence

from arm_control.hardware.resource_manager import ResourceManager
from arm_control.lifecycle import LifecycleState, Transition
from arm_control.loop.supervision import failure_of
from arm_control.manager.loaded_controllers import LoadedControllers, ManagedController
from arm_control.manager.switch_planner import (
    Strictness,
    SwitchPlan,
    SwitchPlanner,
    SwitchRefusedError,
    SwitchRequest,
    SwitchResult,
)

logger = logging.getLogger("controller_manager")

DEFAULT_NAME = "/controller_manager"
"""The manager's node that command-line tools use by default."""

NOTHING_TO_SWITCH = (
    "After checking the controllers, no controllers need to be activated or deactivated."
)
PREPARE_REJECTED = "Could not switch controllers since prepare command mode switch was rejected."
SWITCHED = "Successfully switched controllers!"
SWITCH_FAILED = "Failed switching controllers.... "


def manager_option(manager_name: str) -> str:
    """Return the option with which a command line finds a manager; empty for the default one."""
    return "" if manager_name == DEFAULT_NAME else f" -c {manager_name}"


TransitionListener = Callable[[str, Transition, LifecycleState, LifecycleState], None]
"""Is told of an attempted transition: controller, transition, state before, state after."""


class ControllerSwitcher:
    """Runs the transitions of controllers, and claims and loans their interfaces.

    Loop thread only. In a switch the hardware's command modes change first, then controllers are
    deactivated, then others are activated. The methods for one controller return why it failed, or
    an empty string; the manager checks that the transition is allowed from the current state.
    """

    def __init__(
        self,
        loaded: LoadedControllers,
        resources: ResourceManager,
        listener: TransitionListener,
        manager_name: str,
    ) -> None:
        self._loaded = loaded
        self._resources = resources
        self._listener = listener
        self._manager_option = manager_option(manager_name)

    def switch(self, request: SwitchRequest) -> SwitchResult:
        """Carry out a request, as far as its strictness and the current states allow."""
        try:
            plan = SwitchPlanner(self._loaded, self._resources, request).plan()
        except SwitchRefusedError as error:
            logger.error("no controller is switched: %s %s", str(error).rstrip(), error.hint)
            return SwitchResult(False, str(error))
        if not plan.activate and not plan.deactivate:
            return SwitchResult(True, NOTHING_TO_SWITCH)
        reason = self._rivals(plan) or self._resources.prepare_mode_switch(
            plan.start_interfaces, plan.stop_interfaces
        )
        if reason:
            logger.error("%s (%s)", PREPARE_REJECTED, reason)
            return SwitchResult(False, PREPARE_REJECTED)
        reason = self._resources.perform_mode_switch(plan.start_interfaces, plan.stop_interfaces)
        if reason:
            logger.error("Error while performing mode switch: %s", reason)
            return _failed(plan.activate, plan.deactivate)
        return self._carry_out(plan, request)

    def deactivate(self, controllers: Sequence[ManagedController]) -> None:
        """Deactivate those of these that are active, after errors and at the end."""
        controllers = [controller for controller in controllers if controller.is_active]
        if not controllers:
            return
        self._leave_modes([name for controller in controllers for name in controller.commands])
        for controller in self._from_above(controllers):
            self._deactivate_one(controller)
        self._set_chained_modes()

    def replace_failed(self, failed: Sequence[ManagedController]) -> None:
        """Deactivate controllers whose update failed, and activate their fallbacks.

        Controllers that are connected with them by commands or exported states are deactivated too.
        """
        stopped = self._loaded.with_group(failed)
        names = " ".join(controller.name for controller in stopped)
        logger.error(
            "Deactivating controllers : [ %s ] as their update resulted in an error!", names
        )
        self.deactivate(stopped)
        fallbacks = dict.fromkeys(name for c in failed for name in c.fallback_names)
        if not fallbacks:
            logger.error(
                "They take no commands now. Once the cause is gone, activate again with: "
                "arm control switch_controllers --activate %s%s",
                names,
                self._manager_option,
            )
            return
        logger.error("Activating fallback controllers : [ %s ]", " ".join(fallbacks))
        self.switch(
            SwitchRequest(
                tuple(name for name in fallbacks if not self._is_active(name)),
                tuple(c.name for c in self._loaded.with_preceding(self._holders_for(fallbacks))),
                Strictness.STRICT,
            )
        )

    # One controller

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

    def _activate_one(self, managed: ManagedController) -> str:
        """Loan and claim the interfaces, then activate the controller."""
        reason = self._run(managed, Transition.ACTIVATE, lambda: self._lend(managed))
        reason = reason or self._run(managed, Transition.ACTIVATE, managed.controller.on_activate)
        if reason:
            self._take_interfaces(managed)
        return self._arrive(managed, Transition.ACTIVATE, reason)

    def _deactivate_one(self, managed: ManagedController) -> str:
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

    # Switches

    def _rivals(self, plan: SwitchPlan) -> str:
        """Return which two controllers would command one joint in different modes, if any."""
        stays = [c for c in self._loaded.active() if c not in plan.deactivate]
        holders: dict[str, tuple[ManagedController, str]] = {}
        for controller in (*stays, *plan.activate):
            for name in controller.commands:
                joint = self._resources.moded_joint(name)
                if joint is None:
                    continue
                holder, held = holders.setdefault(joint, (controller, name))
                if holder is not controller:
                    return (
                        f"joint '{joint}' obeys one kind of command at a time: controller "
                        f"'{holder.name}' claims '{held}', and '{controller.name}' '{name}'"
                    )
        return ""

    def _carry_out(self, plan: SwitchPlan, request: SwitchRequest) -> SwitchResult:
        modes = {controller: controller.commands for controller in plan.activate}
        stuck = [c for c in self._from_above(plan.deactivate) if self._deactivate_one(c)]
        self._set_chained_modes(plan.activate)
        refused = self._activate(plan.activate, stuck)
        if refused:
            self._set_chained_modes()
            self._leave_modes([name for controller in refused for name in modes[controller]])
            if request.is_strict:
                self.deactivate([c for c in plan.activate if c.is_active])
        if stuck or refused:
            return _failed(refused, stuck)
        return _succeeded(plan, request)

    def _activate(
        self, controllers: Sequence[ManagedController], stuck: Sequence[ManagedController]
    ) -> list[ManagedController]:
        """Activate these, following ones first, except those in `stuck`; return the failed ones."""
        refused = [controller for controller in controllers if controller in stuck]
        for controller in self._loaded.from_below(c for c in controllers if c not in stuck):
            missing = [c.name for c in self._loaded.following(controller) if c in refused]
            if missing:
                logger.error(
                    "controller '%s' is not activated, because %s was not",
                    controller.name,
                    " ".join(missing),
                )
            if missing or self._activate_one(controller):
                refused.append(controller)
        return refused

    def _from_above(
        self, controllers: Sequence[ManagedController]
    ) -> tuple[ManagedController, ...]:
        return self._loaded.from_below(controllers[::-1])[::-1]

    def _leave_modes(self, commands: Sequence[str]) -> None:
        reason = self._resources.perform_mode_switch((), commands)
        if reason:
            logger.error("Error while performing mode switch: %s", reason)

    def _set_chained_modes(self, activated: Sequence[ManagedController] = ()) -> None:
        """Set the chained mode of each controller whose references another one commands.

        The `activated` ones are about to be active.
        """
        every = tuple(self._loaded.values())
        commanding = [c for c in every if c.is_active or c in activated]
        for controller in every:
            controller.set_chained(self._loaded.is_commanded(controller, commanding))

    def _is_active(self, name: str) -> bool:
        controller = self._loaded.get(name)
        return controller is not None and controller.is_active

    def _holders_for(self, names: Iterable[str]) -> Iterable[ManagedController]:
        """Yield the controllers that have claimed interfaces of these inactive controllers."""
        for name in names:
            controller = self._loaded.get(name)
            if controller is None or controller.is_active:
                continue
            for command in controller.commands:
                holder = self._resources.claimant(command)
                if holder is not None:
                    yield self._loaded[holder]


def _succeeded(plan: SwitchPlan, request: SwitchRequest) -> SwitchResult:
    lists = _listed("\nDeactivated controllers", plan.deactivate)
    lists += _listed("\nActivated controllers", plan.activate)
    logger.info("%s%s", SWITCHED, lists.replace("\n", " "))
    return SwitchResult(True, SWITCHED if request.is_strict else SWITCHED + lists)


def _failed(
    refused: Sequence[ManagedController], stuck: Sequence[ManagedController]
) -> SwitchResult:
    message = SWITCH_FAILED
    message += _listed("\nUnable to activate controllers", refused)
    message += _listed("\nUnable to deactivate controllers", stuck)
    return SwitchResult(False, message)


def _listed(title: str, controllers: Sequence[ManagedController]) -> str:
    return f"{title}: [ {' '.join(c.name for c in controllers)} ]" if controllers else ""


def _repeated_names(kind: str, names: tuple[str, ...]) -> str:
    repeated = sorted(name for name, count in Counter(names).items() if count > 1)
    return f"it requests {kind} interface {', '.join(repeated)} more than once" if repeated else ""
