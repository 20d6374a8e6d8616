"""The state of a controller manager: what its next cycle depends on."""

from collections.abc import Callable, Iterator, Mapping
from contextlib import AbstractContextManager
from typing import Any

from arm_control.controllers.controller import ChainableController
from arm_control.errors import ControllerManagerError, StateError
from arm_control.hardware.command_limits import CommandLimiter
from arm_control.hardware.resource_manager import ResourceManager
from arm_control.lifecycle import LifecycleState
from arm_control.loop.supervision import failure_of
from arm_control.manager.controller_switcher import ControllerSwitcher
from arm_control.manager.hardware_lifecycle import HardwareLifecycle
from arm_control.manager.loaded_controllers import LoadedControllers, ManagedController
from arm_control.manager.running_controllers import LATCHED, RunningControllers
from arm_control.manager.switch_planner import Strictness, SwitchRequest
from arm_control.state.encoding import NotPlainError, encode

CONFIGURED = (LifecycleState.INACTIVE, LifecycleState.ACTIVE)


class ManagerState:
    """Saves, restores and resets a manager's controllers and components. Loop thread only."""

    def __init__(
        self,
        loaded: LoadedControllers,
        resources: ResourceManager,
        switcher: ControllerSwitcher,
        hardware: HardwareLifecycle,
        active: RunningControllers,
        limiter: CommandLimiter | None,
        tracking: Callable[[], AbstractContextManager[None]],
    ) -> None:
        """Refer to the manager's parts; `tracking` updates it afterwards, if anything changed.

        While the emergency stop is engaged, nothing is saved or restored.
        """
        self._loaded = loaded
        self._resources = resources
        self._switcher = switcher
        self._hardware = hardware
        self._active = active
        self._limiter = limiter
        self._tracking = tracking

    def save(self) -> dict[str, Any]:
        """Return the state as plain values, which may share arrays with the manager.

        Raises:
            StateError: some controllers cannot be saved; the message names all of them.
        """
        self._check_released()
        refused: list[str] = []
        controllers = {managed.name: _saved(managed, refused) for managed in self._loaded.values()}
        if refused:
            raise StateError("; ".join(refused))
        return {
            "components": {
                name: (component.state, component.save_state())
                for name, component in self._resources.components.items()
            },
            "controllers": controllers,
            "states": self._resources.states,
            "commands": self._resources.commands,
            "limits": None if self._limiter is None else self._limiter.save_state(),
        }

    def check(self, state: Mapping[str, Any]) -> None:
        """Check that a saved state fits.

        Raises:
            StateError: it does not; the message says what differs.
        """
        self._check_released()
        present, saved = list(self._resources.components), list(state["components"])
        if present != saved:
            raise StateError(
                f"the snapshot has the hardware components {', '.join(saved) or 'none'}; "
                f"here are {', '.join(present) or 'none'}"
            )
        problems = [
            f"hardware component '{name}' is finalized, which it cannot leave"
            for name, (target, _) in state["components"].items()
            if target is not LifecycleState.FINALIZED
            and self._resources.components[name].state is LifecycleState.FINALIZED
        ]
        problems += [
            problem
            for name, controller in state["controllers"].items()
            for problem in self._misfits(name, controller)
        ]
        if problems:
            raise StateError("; ".join(problems))

    def align(self, state: Mapping[str, Any]) -> None:
        """Bring components and controllers to their life-cycle states in a state that fits.

        Raises:
            StateError: one refuses its transition.
        """
        with self._tracking():
            self._align(state)

    def load(self, state: Mapping[str, Any]) -> None:
        """Restore a state for which `align` has been called; nothing is run."""
        for name, controller in state["controllers"].items():
            if controller["state"] in CONFIGURED:
                self._load_controller(self._loaded[name], controller)
        for name, (_, component) in state["components"].items():
            self._resources.components[name].load_state(component)
        self._resources.states[:] = state["states"]
        self._resources.commands[:] = state["commands"]
        if self._limiter is not None and state["limits"] is not None:
            self._limiter.load_state(state["limits"])

    def reset(self) -> None:
        """Make components and active controllers start over, after the simulation was reset.

        Raises:
            StateError: some controllers refuse; the message names all of them.
        """
        for component in self._resources.components.values():
            component.reset()
        if self._limiter is not None:
            self._limiter.restart()
        active = [c for c in self._loaded.active() if not c.is_halted]
        reasons = {
            managed.name: failure_of(
                managed.controller.on_reset, f"on_reset of controller '{managed.name}'"
            )
            for managed in self._loaded.from_below(active)
        }
        self.restart_cadences()
        if self._active.is_stopped:
            self._active.hold_here()
        failed = [f"controller '{name}': {reason}" for name, reason in reasons.items() if reason]
        if failed:
            raise StateError("; ".join(failed))

    def restart_cadences(self) -> None:
        """Treat the next cycle as the first of all components and controllers."""
        for part in (*self._resources.components.values(), *self._loaded.values()):
            part.restart_cadence()

    def fingerprint(self) -> Iterator[tuple[str, bytes]]:
        """Yield the parts of the state by name, as bytes that differ if the state does."""
        yield "commands", self._resources.commands.tobytes()
        for managed in self._loaded.active():
            yield managed.name, managed.controller.fingerprint()

    def _check_released(self) -> None:
        if self._active.is_stopped:
            raise StateError(LATCHED)

    def _align(self, state: Mapping[str, Any]) -> None:
        saved = state["controllers"]
        active = {name for name in saved if saved[name]["state"] is LifecycleState.ACTIVE}
        stop = [c.name for c in self._loaded.in_order() if c.is_active and c.name not in active]
        start = [name for name in saved if name in active and not self._loaded[name].is_active]
        targets = {name: target for name, (target, _) in state["components"].items()}
        if start:
            # A controller may have been active before its hardware became inactive.
            self._bring_components(
                {
                    name: LifecycleState.ACTIVE if target is LifecycleState.INACTIVE else target
                    for name, target in targets.items()
                }
            )
            stop = [name for name in stop if self._loaded[name].is_active]
        if start or stop:
            request = SwitchRequest(tuple(start), tuple(stop), Strictness.STRICT)
            result = self._switcher.switch(request)
            if not result.ok:
                raise StateError(f"the snapshot's controllers do not start: {result.message}")
        self._bring_components(targets)
        # Controllers run in the reverse order of their loading.
        for name in saved:
            self._loaded[name] = self._loaded.pop(name)

    def _bring_components(self, targets: Mapping[str, LifecycleState]) -> None:
        for name, target in targets.items():
            if self._resources.components[name].state is not target:
                try:
                    self._hardware.set_state(name, target)
                except ControllerManagerError as error:
                    raise StateError(f"{error}") from error

    def _load_controller(self, managed: ManagedController, saved: Mapping[str, Any]) -> None:
        managed.load_state(saved["content"])
        controller = managed.controller
        if isinstance(controller, ChainableController):
            controller.references[:], controller.exported_states[:] = saved["exports"]

    def _misfits(self, name: str, saved: Mapping[str, Any]) -> Iterator[str]:
        managed = self._loaded.get(name)
        if managed is None:
            loaded = ", ".join(self._loaded) or "none"
            yield f"the snapshot has controller '{name}', which is not loaded; loaded: {loaded}"
        elif managed.type_name != saved["type"]:
            yield f"controller '{name}' was a {saved['type']} and is a {managed.type_name} now"
        elif saved["state"] in CONFIGURED and managed.state not in CONFIGURED:
            yield (
                f"controller '{name}' was {saved['state'].label} and is {managed.state.label} now; "
                "configure it first"
            )
        elif saved["state"] in CONFIGURED and managed.commands != saved["commands"]:
            yield (
                f"controller '{name}' claimed {', '.join(saved['commands']) or 'nothing'} and "
                f"claims {', '.join(managed.commands) or 'nothing'} now"
            )


def _saved(managed: ManagedController, refused: list[str]) -> dict[str, Any] | None:
    """Return the state of a controller; add a sentence to `refused` if it cannot be saved."""
    saved: dict[str, Any] = {
        "type": managed.type_name,
        "state": managed.state,
        "commands": managed.commands,
    }
    if managed.state not in CONFIGURED:
        return saved
    controller = managed.controller
    if isinstance(controller, ChainableController):
        saved["exports"] = (controller.references, controller.exported_states)
    try:
        saved["content"] = managed.save_state()
        encode(saved["content"])
    except NotPlainError as error:
        refused.append(
            f"controller '{managed.name}' cannot be saved: its attribute "
            f"{error.path.removeprefix('[1].')} {error.reason}; define save_state and load_state, "
            "or list the attribute in 'transient' if it is not part of the state"
        )
    except Exception as error:
        # A controller is user code and may raise anything.
        refused.append(
            f"controller '{managed.name}' cannot be saved: its save_state raised "
            f"{type(error).__name__}: {error}"
        )
    return saved
