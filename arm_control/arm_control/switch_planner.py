"""Decides what a switch request comes to, in ros2_control's own order, before anything changes."""

import logging
from collections.abc import Callable, Iterable, Mapping, Sequence
from dataclasses import dataclass

from arm_control.controller_chain import ControllerChain
from arm_control.controller_switch import SwitchRequest
from arm_control.errors import ControllerManagerError
from arm_control.lifecycle import LifecycleState
from arm_control.managed_controller import ManagedController
from arm_control.resource_manager import ResourceManager

logger = logging.getLogger(__name__)


@dataclass(frozen=True, slots=True)
class SwitchPlan:
    """The controllers to deactivate, then those to activate."""

    activate: tuple[ManagedController, ...]
    deactivate: tuple[ManagedController, ...]

    @property
    def start_interfaces(self) -> tuple[str, ...]:
        """Command interfaces that will be claimed."""
        return tuple(name for controller in self.activate for name in controller.commands)

    @property
    def stop_interfaces(self) -> tuple[str, ...]:
        """Command interfaces that will be released."""
        return tuple(name for controller in self.deactivate for name in controller.commands)


class SwitchRefusedError(ControllerManagerError):
    """A switch that will not be done.

    The message is the service's answer, which clients know word for word; the hint, for the log,
    says what there is.
    """

    def __init__(self, message: str, hint: str = "") -> None:
        super().__init__(message)
        self.hint = hint


class SwitchPlanner:
    """Checks one request against the controllers and interfaces there are."""

    def __init__(
        self,
        controllers: Mapping[str, ManagedController],
        resources: ResourceManager,
        chain: ControllerChain,
        request: SwitchRequest,
    ) -> None:
        self._controllers = controllers
        self._resources = resources
        self._chain = chain
        self._request = request

    def plan(self) -> SwitchPlan:
        """Return what to do; an empty plan where nothing remains to be done.

        Raises:
            SwitchRefusedError: nothing is to be switched.
        """
        deactivate = self._known(self._request.deactivate, "deactivate")
        activate = self._known(self._request.activate, "activate")
        activate = self._accepted(activate, self._why_not_activate)
        deactivate = self._accepted(deactivate, self._why_not_deactivate)
        plan = self._keep_chains(SwitchPlan(tuple(activate), tuple(deactivate)))
        self._check_interfaces(plan)
        return plan

    def _keep_chains(self, plan: SwitchPlan) -> SwitchPlan:
        """Leave out what would break a chain, until nothing would."""
        while True:
            activate = self._accepted(plan.activate, lambda c, p=plan: self._why_not_lead(c, p))
            deactivate = self._accepted(
                plan.deactivate, lambda c, p=plan: self._why_not_leave(c, p)
            )
            kept = SwitchPlan(tuple(activate), tuple(deactivate))
            if kept == plan:
                return plan
            plan = kept

    def _known(self, names: Sequence[str], action: str) -> list[ManagedController]:
        """Return the controllers of these names, each once; unknown names end it or are dropped."""
        known: list[ManagedController] = []
        complaints: list[str] = []
        for name in dict.fromkeys(names):
            controller = self._controllers.get(name)
            if controller is not None:
                known.append(controller)
                continue
            complaint = (
                f"Could not {action} controller with name '{name}' "
                "because no controller with this name exists"
            )
            self._complain(complaint, self._loaded())
            complaints.append(complaint)
        if complaints and not known:
            message = "".join(f"{complaint}\n" for complaint in complaints)
            raise SwitchRefusedError(message, self._loaded())
        return known

    def _accepted(
        self,
        candidates: Iterable[ManagedController],
        why_not: Callable[[ManagedController], str],
    ) -> list[ManagedController]:
        """Return the candidates without those that have a reason against them."""
        accepted: list[ManagedController] = []
        for candidate in candidates:
            reason = why_not(candidate)
            if reason:
                self._complain(reason)
            else:
                accepted.append(candidate)
        return accepted

    def _complain(self, reason: str, hint: str = "") -> None:
        """End a strict switch; say what a best-effort one leaves out."""
        if self._request.is_strict:
            raise SwitchRefusedError(reason, hint)
        logger.warning("%s", reason)

    def _loaded(self) -> str:
        return f"(loaded: {', '.join(self._controllers) or 'none'})"

    def _why_not_activate(self, controller: ManagedController) -> str:
        if controller.state is LifecycleState.ACTIVE:
            if controller.name in self._request.deactivate:
                return ""
            return f"Controller with name '{controller.name}' is already active."
        if controller.state is not LifecycleState.INACTIVE:
            return (
                f"Controller with name '{controller.name}' can not be activated "
                f"since it is {controller.state.label}; it must be configured first."
            )
        return self._why_not_fall_back(controller)

    def _why_not_deactivate(self, controller: ManagedController) -> str:
        if controller.is_active:
            return ""
        return (
            f"Controller with name '{controller.name}' can not be deactivated "
            "since it is not active."
        )

    def _why_not_lead(self, controller: ManagedController, plan: SwitchPlan) -> str:
        """Say which of the controllers that follow would not be active."""
        if controller.is_active and controller not in plan.deactivate:
            return f"Controller with name '{controller.name}' is already active."
        for follower in self._chain.following(controller):
            if follower in plan.activate:
                continue
            if not follower.is_active:
                trouble = "is not active and will not be activated"
            elif follower in plan.deactivate:
                trouble = "will be deactivated"
            else:
                continue
            return (
                f"Controller with name '{controller.name}' can not be activated since "
                f"the following controller with name '{follower.name}' {trouble}."
            )
        return ""

    def _why_not_leave(self, controller: ManagedController, plan: SwitchPlan) -> str:
        """Say which of the controllers that precede would still be active."""
        for leader in self._chain.preceding(controller):
            if leader.is_active and leader not in plan.deactivate:
                return (
                    f"Controller with name '{controller.name}' can not be deactivated since "
                    f"the preceding controller with name '{leader.name}' is active "
                    "and will not be deactivated."
                )
        return ""

    def _why_not_fall_back(self, controller: ManagedController) -> str:
        """Say why the controller's fallbacks could not take over, before they are needed."""
        for name in controller.fallback_names:
            fallback = self._controllers.get(name)
            usable = (LifecycleState.INACTIVE, LifecycleState.ACTIVE)
            if fallback is None or fallback.state not in usable:
                state = "not loaded" if fallback is None else fallback.state.label
                return (
                    f"Controller with name '{controller.name}' can not be activated "
                    f"since its fallback controller '{name}' is {state}."
                )
            missing = self._first_missing(fallback)
            if missing:
                return (
                    f"Controller with name '{controller.name}' can not be activated "
                    f"since its fallback controller '{name}' lacks the interface '{missing}'."
                )
        return ""

    def _first_missing(self, controller: ManagedController) -> str:
        for name in controller.commands:
            if not self._will_take(name):
                return name
        for name in controller.states:
            if not self._will_provide(name):
                return name
        return ""

    def _will_take(self, command: str) -> bool:
        """Whether a command can be claimed; references always, once the chains are checked."""
        if self._resources.exported.reference_owner(command) is not None:
            return True
        return self._resources.is_command_available(command)

    def _will_provide(self, state: str) -> bool:
        """Whether a state can be read; exported ones always, once the chains are checked."""
        if self._resources.exported.state_owner(state) is not None:
            return True
        return self._resources.is_state_available(state)

    def _check_interfaces(self, plan: SwitchPlan) -> None:
        """Refuse the whole plan, strict or not, where an interface is missing or taken."""
        released = {controller.name for controller in plan.deactivate}
        taken: dict[str, str] = {}
        for controller in plan.activate:
            for name in controller.commands:
                claimant = self._resources.claimant(name)
                if not self._will_take(name):
                    trouble = "is not available."
                    hint = f"(available: {', '.join(self._resources.available_commands())})"
                elif claimant is not None and claimant not in released:
                    trouble = "is currently claimed by another controller."
                    hint = f"(by '{claimant}')"
                elif name in taken:
                    trouble = "will be used by another controller that is being activated."
                    hint = f"('{taken[name]}')"
                else:
                    taken[name] = controller.name
                    continue
                raise _unusable(controller, f"command interface '{name}' {trouble}", hint)
            for name in controller.states:
                if not self._will_provide(name):
                    hint = f"(available: {', '.join(self._resources.available_states())})"
                    raise _unusable(controller, f"state interface '{name}' is not available.", hint)


def _unusable(controller: ManagedController, trouble: str, hint: str) -> SwitchRefusedError:
    return SwitchRefusedError(
        f"Unable to activate controller '{controller.name}' since the {trouble}", hint
    )
