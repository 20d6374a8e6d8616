"""Activates and deactivates controllers together, and switches the hardware's command modes."""

import logging
from collections.abc import Iterable, Mapping, Sequence

from arm_control.hardware.resource_manager import ResourceManager
from arm_control.manager.controller_chain import ControllerChain
from arm_control.manager.controller_lifecycle import ControllerLifecycle
from arm_control.manager.managed_controller import ManagedController
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


class ControllerSwitcher:
    """Carries out switches, on request or after a failure.

    Loop thread only. The hardware's command modes change first, then controllers are deactivated,
    then others are activated.
    """

    def __init__(
        self,
        controllers: Mapping[str, ManagedController],
        resources: ResourceManager,
        lifecycle: ControllerLifecycle,
        chain: ControllerChain,
        manager_name: str,
    ) -> None:
        """Refer to the manager's controllers.

        Args:
            controllers: by name; the manager adds and removes some later.
            resources: the hardware.
            lifecycle: runs the transitions of one controller.
            chain: knows which controllers command which.
            manager_name: fully qualified name of the manager's node.
        """
        self._controllers = controllers
        self._resources = resources
        self._lifecycle = lifecycle
        self._chain = chain
        self._manager_option = manager_option(manager_name)

    def switch(self, request: SwitchRequest) -> SwitchResult:
        """Carry out a request, as far as its strictness and the current states allow."""
        try:
            plan = SwitchPlanner(self._controllers, self._resources, self._chain, request).plan()
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
            self._lifecycle.deactivate(controller)
        self._set_chained_modes()

    def replace_failed(self, failed: Sequence[ManagedController]) -> None:
        """Deactivate controllers whose update failed, and activate their fallbacks.

        Controllers that are connected with them by commands or exported states are deactivated too.
        """
        stopped = self._chain.with_group(failed)
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
                tuple(c.name for c in self._chain.with_preceding(self._holders_for(fallbacks))),
                Strictness.STRICT,
            )
        )

    def _rivals(self, plan: SwitchPlan) -> str:
        """Return which two controllers would command one joint in different modes, if any."""
        stays = [c for c in self._controllers.values() if c.is_active and c not in plan.deactivate]
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
        stuck = [c for c in self._from_above(plan.deactivate) if self._lifecycle.deactivate(c)]
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
        for controller in self._chain.from_below(c for c in controllers if c not in stuck):
            missing = [c.name for c in self._chain.following(controller) if c in refused]
            if missing:
                logger.error(
                    "controller '%s' is not activated, because %s was not",
                    controller.name,
                    " ".join(missing),
                )
            if missing or self._lifecycle.activate(controller):
                refused.append(controller)
        return refused

    def _from_above(
        self, controllers: Sequence[ManagedController]
    ) -> tuple[ManagedController, ...]:
        return self._chain.from_below(controllers[::-1])[::-1]

    def _leave_modes(self, commands: Sequence[str]) -> None:
        reason = self._resources.perform_mode_switch((), commands)
        if reason:
            logger.error("Error while performing mode switch: %s", reason)

    def _set_chained_modes(self, activated: Sequence[ManagedController] = ()) -> None:
        """Set the chained mode of each controller whose references another one commands.

        Args:
            activated: controllers that are about to be active.
        """
        every = tuple(self._controllers.values())
        commanding = [c for c in every if c.is_active or c in activated]
        for controller in every:
            controller.set_chained(self._chain.is_commanded(controller, commanding))

    def _is_active(self, name: str) -> bool:
        controller = self._controllers.get(name)
        return controller is not None and controller.is_active

    def _holders_for(self, names: Iterable[str]) -> Iterable[ManagedController]:
        """Yield the controllers that have claimed interfaces of these inactive controllers."""
        for name in names:
            controller = self._controllers.get(name)
            if controller is None or controller.is_active:
                continue
            for command in controller.commands:
                holder = self._resources.claimant(command)
                if holder is not None:
                    yield self._controllers[holder]


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
