"""Plans a switch before anything changes, with ros2_control's checks in their order."""

import logging
from collections.abc import Callable, Iterable, Sequence
from enum import IntEnum

from arm_control.errors import ControllerManagerError
from arm_control.hardware.resource_manager import ResourceManager
from arm_control.lifecycle import LifecycleState
from arm_control.manager.loaded_controllers import (
    LoadedControllers,
    ManagedController,
    unknown_controller,
)
from arm_node.frozen import frozen


class Strictness(IntEnum):
    """How to handle a request that cannot be met in full; numbered as in SwitchController."""

    BEST_EFFORT = 1
    """Skip the controllers that cannot be switched, switch the others."""
    STRICT = 2
    """All or nothing."""
    AUTO = 3
    """Like BEST_EFFORT, as in ros2_control Jazzy."""
    FORCE_AUTO = 4
    """Like BEST_EFFORT, as in ros2_control Jazzy."""


@frozen
class SwitchRequest:
    """Controllers to activate and deactivate in one step; one in both lists is restarted."""

    activate: tuple[str, ...] = ()
    deactivate: tuple[str, ...] = ()
    strictness: Strictness = Strictness.BEST_EFFORT

    @property
    def is_strict(self) -> bool:
        """Whether the request must be met in full."""
        return self.strictness is Strictness.STRICT


@frozen
class SwitchResult:
    """Whether a switch succeeded, with ros2_control's message."""

    ok: bool
    message: str


logger = logging.getLogger("controller_manager")


@frozen
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
    """A switch is refused.

    The message is the service's answer, word for word as in ros2_control; the hint, for the log,
    says what exists.
    """

    def __init__(self, message: str, hint: str = "") -> None:
        super().__init__(message)
        self.hint = hint


class SwitchPlanner:
    """Checks one request against the controllers and interfaces that exist."""

    def __init__(
        self, loaded: LoadedControllers, resources: ResourceManager, request: SwitchRequest
    ) -> None:
        self._loaded = loaded
        self._resources = resources
        self._request = request

    def plan(self) -> SwitchPlan:
        """Return the plan; it is empty if nothing needs to be switched.

        Raises:
            SwitchRefusedError: the whole request is refused.
        """
        deactivate = self._known(self._request.deactivate, "deactivate")
        activate = self._known(self._request.activate, "activate")
        activate = self._accepted(activate, self._why_not_activate)
        deactivate = self._accepted(deactivate, self._why_not_deactivate)
        plan = self._keep_chains(SwitchPlan(tuple(activate), tuple(deactivate)))
        self._check_interfaces(plan)
        return plan

    def _keep_chains(self, plan: SwitchPlan) -> SwitchPlan:
        """Drop controllers whose switch would break a chain, until none would."""
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
        """Return the controllers of these names, each once; refuse or skip unknown names."""
        known: list[ManagedController] = []
        reasons: list[str] = []
        for name in dict.fromkeys(names):
            controller = self._loaded.get(name)
            if controller is not None:
                known.append(controller)
                continue
            reason = unknown_controller(name, action)
            self._skip_or_refuse(reason, self._names())
            reasons.append(reason)
        if reasons and not known:
            message = "".join(f"{reason}\n" for reason in reasons)
            raise SwitchRefusedError(message, self._names())
        return known

    def _accepted(
        self, candidates: Iterable[ManagedController], why_not: Callable[[ManagedController], str]
    ) -> list[ManagedController]:
        """Return the candidates for which `why_not` gives no reason."""
        accepted: list[ManagedController] = []
        for candidate in candidates:
            reason = why_not(candidate)
            if reason:
                self._skip_or_refuse(reason)
            else:
                accepted.append(candidate)
        return accepted

    def _skip_or_refuse(self, reason: str, hint: str = "") -> None:
        """Refuse a strict request; log what a best-effort one skips."""
        if self._request.is_strict:
            raise SwitchRefusedError(reason, hint)
        logger.warning("%s", reason)

    def _names(self) -> str:
        return f"(loaded: {', '.join(self._loaded) or 'none'})"

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
        """Return which following controller would not be active, as a message."""
        if controller.is_active and controller not in plan.deactivate:
            return f"Controller with name '{controller.name}' is already active."
        for follower in self._loaded.following(controller):
            if follower in plan.activate:
                continue
            if not follower.is_active:
                problem = "is not active and will not be activated"
            elif follower in plan.deactivate:
                problem = "will be deactivated"
            else:
                continue
            return (
                f"Controller with name '{controller.name}' can not be activated since "
                f"the following controller with name '{follower.name}' {problem}."
            )
        return ""

    def _why_not_leave(self, controller: ManagedController, plan: SwitchPlan) -> str:
        """Return which preceding controller would still be active, as a message."""
        for leader in self._loaded.preceding(controller):
            if leader.is_active and leader not in plan.deactivate:
                return (
                    f"Controller with name '{controller.name}' can not be deactivated since "
                    f"the preceding controller with name '{leader.name}' is active "
                    "and will not be deactivated."
                )
        return ""

    def _why_not_fall_back(self, controller: ManagedController) -> str:
        """Return why the controller's fallbacks could not replace it, as a message."""
        for name in controller.fallback_names:
            fallback = self._loaded.get(name)
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
        """Whether a command can be claimed; references always, since the chains are checked."""
        if self._resources.exported.reference_owner(command) is not None:
            return True
        return self._resources.is_command_available(command)

    def _will_provide(self, state: str) -> bool:
        """Whether a state can be read; exported ones always, since the chains are checked."""
        if self._resources.exported.state_owner(state) is not None:
            return True
        return self._resources.is_state_available(state)

    def _check_interfaces(self, plan: SwitchPlan) -> None:
        """Refuse the whole plan, strict or not, if an interface is missing or claimed."""
        released = {controller.name for controller in plan.deactivate}
        taken: dict[str, str] = {}
        for controller in plan.activate:
            for name in controller.commands:
                claimant = self._resources.claimant(name)
                if not self._will_take(name):
                    problem = "is not available."
                    hint = f"(available: {', '.join(self._resources.available_commands())})"
                elif claimant is not None and claimant not in released:
                    problem = "is currently claimed by another controller."
                    hint = f"(by '{claimant}')"
                elif name in taken:
                    problem = "will be used by another controller that is being activated."
                    hint = f"('{taken[name]}')"
                else:
                    taken[name] = controller.name
                    continue
                raise _unusable(controller, f"command interface '{name}' {problem}", hint)
            for name in controller.states:
                if not self._will_provide(name):
                    hint = f"(available: {', '.join(self._resources.available_states())})"
                    raise _unusable(controller, f"state interface '{name}' is not available.", hint)


def _unusable(controller: ManagedController, problem: str, hint: str) -> SwitchRefusedError:
    return SwitchRefusedError(
        f"Unable to activate controller '{controller.name}' since the {problem}", hint
    )
