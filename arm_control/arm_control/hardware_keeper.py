"""Takes hardware components from state to state, with the controllers that depend on them."""

import logging
from collections.abc import Iterable, Mapping, Sequence

from arm_control.controller_chain import ControllerChain
from arm_control.controller_switcher import ControllerSwitcher
from arm_control.errors import ControllerManagerError
from arm_control.hardware import HardwareReturn
from arm_control.hardware_component import HardwareComponent
from arm_control.lifecycle import LifecycleState
from arm_control.managed_controller import ManagedController
from arm_control.manager_policy import ManagerPolicy
from arm_control.resource_manager import ResourceManager, Trouble

logger = logging.getLogger(__name__)


class HardwareKeeper:
    """Brings components up, down, and out of use; stops controllers whose interfaces vanish.

    Loop thread only.
    """

    def __init__(
        self,
        controllers: Mapping[str, ManagedController],
        resources: ResourceManager,
        chain: ControllerChain,
        switcher: ControllerSwitcher,
        policy: ManagerPolicy,
    ) -> None:
        """Watch over the manager's components.

        Args:
            controllers: by name; the manager goes on adding and removing.
            resources: the components.
            chain: tells who commands whom.
            switcher: stops controllers.
            policy: what to do where there is a choice.
        """
        self._controllers = controllers
        self._resources = resources
        self._chain = chain
        self._switcher = switcher
        self._policy = policy

    def bring_up(self, unconfigured: Iterable[str], inactive: Iterable[str]) -> None:
        """Activate every component but those named, group by group.

        Raises:
            ControllerManagerError: a name is unknown, or a component did not get there and the
                policy does not let that pass.
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
        """Walk a component to a state.

        Raises:
            ControllerManagerError: there is no such component, or it stopped short.
        """
        self._check([name])
        if target in (LifecycleState.UNCONFIGURED, LifecycleState.FINALIZED):
            self._switcher.deactivate(self._users_of(name))
        reason = self._resources.set_component_state(name, target)
        if reason:
            raise ControllerManagerError(reason)

    def stop_troubled(self, trouble: Sequence[Trouble], exchange: str) -> None:
        """Take components down that failed, or deactivate those that asked for it."""
        for component, outcome in trouble:
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
        """Finalize every component; no controller is active any more."""
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
            # Active it would ask again in every cycle; it failed like one whose exchange fails.
            logger.error(
                "hardware component '%s' cannot deactivate itself and is taken down: %s",
                component.name,
                reason,
            )
            self._switcher.deactivate(self._users_of(component.name))
            self._resources.take_down(component)

    def _bring_up_together(self, targets: Mapping[str, LifecycleState]) -> None:
        """Configure all before the first is activated; where one of several fails, all go back."""
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
                known = ", ".join(components) or "no component"
                raise ControllerManagerError(f"no hardware component '{name}'; there is {known}")

    def _users_of(
        self, component: str, *, commanding_only: bool = False
    ) -> Sequence[ManagedController]:
        """Return the active controllers that use a component, and those that command them."""
        return self._chain.with_preceding(
            c
            for c in self._controllers.values()
            if c.is_active
            and component
            in self._resources.components_of(() if commanding_only else c.states, c.commands)
        )
