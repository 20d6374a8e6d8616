"""Runs the life-cycle transitions of hardware components, and stops dependent controllers."""

import logging
from collections.abc import Iterable, Mapping, Sequence

from arm_control.errors import ControllerManagerError
from arm_control.hardware.component import HardwareComponent
from arm_control.hardware.driver import HardwareReturn
from arm_control.hardware.resource_manager import HardwareFault, ResourceManager
from arm_control.lifecycle import LifecycleState
from arm_control.manager.controller_switcher import ControllerSwitcher
from arm_control.manager.loaded_controllers import LoadedControllers, ManagedController
from arm_control.manager.settings import ManagerPolicy

logger = logging.getLogger("controller_manager")


class HardwareLifecycle:
    """Brings components up and down; stops controllers whose interfaces disappear.

    Loop thread only.
    """

    def __init__(
        self,
        loaded: LoadedControllers,
        resources: ResourceManager,
        switcher: ControllerSwitcher,
        policy: ManagerPolicy,
    ) -> None:
        self._loaded = loaded
        self._resources = resources
        self._switcher = switcher
        self._policy = policy

    def bring_up(self, unconfigured: Iterable[str], inactive: Iterable[str]) -> None:
        """Bring every component to its initial state, active unless named, group by group.

        Raises:
            ControllerManagerError: a name is unknown, or a component did not reach its state and
                the policy makes that an error.
        """
        targets = dict.fromkeys(self._resources.components, LifecycleState.ACTIVE)
        targets.update(dict.fromkeys(inactive, LifecycleState.INACTIVE))
        targets.update(dict.fromkeys(unconfigured, LifecycleState.UNCONFIGURED))
        self._check(targets)
        for members in self._resources.groups():
            try:
                self._bring_up_together({name: targets[name] for name in members})
            except ControllerManagerError as error:
                if self._policy.end_on_initial_state_failure:
                    raise
                logger.error("%s", error)

    def set_state(self, name: str, target: LifecycleState) -> None:
        """Bring a component to a state.

        Raises:
            ControllerManagerError: there is no such component, or a transition failed.
        """
        self._check([name])
        if target in (LifecycleState.UNCONFIGURED, LifecycleState.FINALIZED):
            self._switcher.deactivate(self._users_of(name))
        reason = self._resources.set_component_state(name, target)
        if reason:
            raise ControllerManagerError(reason)

    def stop_faulty(self, faults: Sequence[HardwareFault], exchange: str) -> None:
        """Take failed components out of use; deactivate those that requested it."""
        for component, outcome in faults:
            if outcome is HardwareReturn.DEACTIVATE:
                self._deactivate(component)
            else:
                logger.error(
                    "Deactivating following hardware components as their %s cycle resulted in "
                    "an error: [ %s ]",
                    exchange,
                    component.name,
                )
                self._switcher.deactivate(self._users_of(component.name))
                self._resources.take_down(component)

    def shut_down(self) -> None:
        """Finalize every component; all controllers are inactive by now."""
        for name, component in self._resources.components.items():
            if component.state is not LifecycleState.FINALIZED:
                reason = self._resources.set_component_state(name, LifecycleState.FINALIZED)
                if reason:
                    logger.error("%s", reason)

    def _deactivate(self, component: HardwareComponent) -> None:
        logger.error("hardware component '%s' deactivates itself", component.name)
        if self._policy.stop_with_self_deactivated_hardware:
            self._switcher.deactivate(self._users_of(component.name, commanding_only=True))
        reason = self._resources.set_component_state(component.name, LifecycleState.INACTIVE)
        if reason:
            # If it stayed active, it would ask again in every cycle.
            logger.error(
                "hardware component '%s' cannot deactivate itself and is taken out of use: %s",
                component.name,
                reason,
            )
            self._switcher.deactivate(self._users_of(component.name))
            self._resources.take_down(component)

    def _bring_up_together(self, targets: Mapping[str, LifecycleState]) -> None:
        """Configure all before activating the first; if one of several fails, clean up all."""
        try:
            for step in (LifecycleState.INACTIVE, LifecycleState.ACTIVE):
                for name, target in targets.items():
                    if target >= step:
                        self.set_state(name, step)
        except ControllerManagerError:
            if len(targets) > 1:
                for name in targets:
                    self._resources.set_component_state(name, LifecycleState.UNCONFIGURED)
            raise

    def _check(self, names: Iterable[str]) -> None:
        components = self._resources.components
        for name in names:
            if name not in components:
                known = ", ".join(components) or "none"
                raise ControllerManagerError(
                    f"no hardware component '{name}'; the components are {known}"
                )

    def _users_of(
        self, component: str, *, commanding_only: bool = False
    ) -> Sequence[ManagedController]:
        """Return the active controllers that use a component, and those that command them."""
        return self._loaded.with_preceding(
            c
            for c in self._loaded.active()
            if component
            in self._resources.components_of(() if commanding_only else c.states, c.commands)
        )
