"""Loads, configures, switches and updates controllers on top of hardware components."""

import logging
from collections.abc import Iterable, Iterator, Mapping, Sequence
from contextlib import contextmanager
from types import MappingProxyType
from typing import Any, Protocol

from arm_control.command_limiter import CommandLimiter
from arm_control.controller import Controller
from arm_control.controller_chain import ControllerChain
from arm_control.controller_lifecycle import ControllerLifecycle
from arm_control.controller_switch import SwitchRequest, SwitchResult
from arm_control.controller_switcher import DEFAULT_NAME, ControllerSwitcher
from arm_control.errors import ControllerManagerError
from arm_control.guarded import log_failure, raise_failure
from arm_control.hardware import Hardware
from arm_control.hardware_keeper import HardwareKeeper
from arm_control.joint_limits import JointLimits
from arm_control.lifecycle import LifecycleState, Transition
from arm_control.managed_controller import ManagedController
from arm_control.manager_policy import ManagerPolicy
from arm_control.resource_manager import ResourceManager, Trouble
from arm_control.run_record import RunRecord
from arm_control.run_supervision import RunSupervision
from arm_control.status import ControllerStatus, HardwareComponentStatus, InterfaceStatus

STATISTICS_S = 5
"""The statistics speak of the last few seconds: a stall shows for a while, not for ever."""

DEFAULT_POLICY = ManagerPolicy()
NO_LIMITS: Mapping[str, JointLimits] = MappingProxyType({})

logger = logging.getLogger(__name__)


class ManagerObserver(Protocol):
    """Hears of changes; called on the loop thread, so it must be quick and must not raise."""

    def controller_transitioned(
        self, name: str, transition: Transition, start: LifecycleState, end: LifecycleState
    ) -> None:
        """A controller tried a transition; `end` is the transition's goal where it succeeded."""
        ...

    def activity_changed(self) -> None:
        """The set of controllers or components, or the state of one of them, has changed."""
        ...


class ControllerManager:
    """The heart of ros2_control: components below, controllers above, one tick at a time.

    Single-threaded: every method belongs to the loop thread (or to the only thread there is).
    A tick calls, in this order, `update`, `write`, then, once the world has moved on, `read`
    and `publish`: commands take effect before the state that answers them is published.

    Methods that change something raise `ControllerManagerError` with the reason for a refusal.

    Attributes:
        update_rate_hz: ticks per second.
        resources: the components, and the arrays of states and commands.
        updates: its latest updates, with the periods of its cycles.
    """

    def __init__(
        self,
        hardware: Sequence[Hardware],
        update_rate_hz: int,
        policy: ManagerPolicy = DEFAULT_POLICY,
        limits: Mapping[str, JointLimits] = NO_LIMITS,
        name: str = DEFAULT_NAME,
    ) -> None:
        """Take over the components, all still unconfigured; see `bring_up`.

        Args:
            hardware: the components' drivers.
            update_rate_hz: ticks per second.
            policy: what to do where there is a choice.
            limits: by joint, for the commands of joints that are to be kept within them.
            name: of its node, fully qualified, as users are to write it.

        Raises:
            ControllerManagerError: the rate is not positive, or names are used twice.
        """
        if update_rate_hz < 1:
            raise ControllerManagerError(f"update_rate must be positive, not {update_rate_hz} Hz")
        self.update_rate_hz = update_rate_hz
        self._supervision = RunSupervision(
            samples=STATISTICS_S * update_rate_hz,
            on_exception=log_failure if policy.handle_exceptions else raise_failure,
        )
        self.updates = self._supervision.record()
        self.resources = ResourceManager(
            hardware,
            update_rate_hz,
            self._supervision,
            command_inactive=policy.activate_with_inactive_hardware,
        )
        self._limiter = CommandLimiter(limits, self.resources) if limits else None
        self._controllers: dict[str, ManagedController] = {}
        self._commanding: tuple[ManagedController, ...] = ()
        self._broadcasting: tuple[ManagedController, ...] = ()
        self._lifecycle = ControllerLifecycle(self.resources, self._controller_transitioned)
        self._chain = ControllerChain(self._controllers, self.resources.exported)
        self._switcher = ControllerSwitcher(
            self._controllers, self.resources, self._lifecycle, self._chain, name
        )
        self._keeper = HardwareKeeper(
            self._controllers, self.resources, self._chain, self._switcher, policy
        )
        self._observers: list[ManagerObserver] = []
        self._changes = 0

    def add_observer(self, observer: ManagerObserver) -> None:
        """Tell this observer of every change from now on."""
        self._observers.append(observer)

    # One tick

    def update(self, time_s: float, period_s: float) -> None:
        """Run the controllers that command something, and those whose exported states they read."""
        began_s = self._supervision.now_s()
        failed = [c for c in self._commanding if not c.run(time_s, period_s)]
        if failed:
            self._replace_failed(failed)
        self.updates.add(period_s, self._supervision.now_s() - began_s)

    def write(self, time_s: float, period_s: float) -> None:
        """Hand the commands, within their limits, to the hardware."""
        if self._limiter is not None:
            self._limiter.enforce(period_s)
        trouble = self.resources.write(time_s, period_s)
        if trouble:
            self._stop_troubled(trouble, "write")

    def read(self, time_s: float, period_s: float) -> None:
        """Fetch the states from the hardware."""
        trouble = self.resources.read(time_s, period_s)
        if trouble:
            self._stop_troubled(trouble, "read")

    def publish(self, time_s: float, period_s: float) -> None:
        """Run the others: those that only look at states, such as broadcasters."""
        failed = [c for c in self._broadcasting if not c.run(time_s, period_s)]
        if failed:
            self._replace_failed(failed)

    # Hardware

    def bring_up(self, unconfigured: Iterable[str] = (), inactive: Iterable[str] = ()) -> None:
        """Activate every component but those named, which stop at the state named; read once.

        Components of one group are all configured before the first of them is activated; where
        one of them fails, all go back.

        Raises:
            ControllerManagerError: a name is unknown, or a component did not get there and the
                policy does not let that pass.
        """
        try:
            self._keeper.bring_up(unconfigured, inactive)
        finally:
            self._select_active()
        self.read(0.0, 1.0 / self.update_rate_hz)
        for component in self.resources.components.values():
            component.restart_cadence()

    def set_hardware_component_state(self, name: str, target: LifecycleState) -> None:
        """Walk a component to a state; controllers stop where their interfaces vanish."""
        with self._following():
            self._keeper.set_state(name, target)

    def list_hardware_components(self) -> tuple[HardwareComponentStatus, ...]:
        """Return every component."""
        return self.resources.list_components()

    def component_runs(self) -> tuple[tuple[HardwareComponentStatus, RunRecord, RunRecord], ...]:
        """Return every component with the records of its reads and its writes."""
        return tuple(
            (status, component.reads, component.writes)
            for status, component in zip(
                self.list_hardware_components(), self.resources.components.values(), strict=True
            )
        )

    def list_hardware_interfaces(
        self,
    ) -> tuple[tuple[InterfaceStatus, ...], tuple[InterfaceStatus, ...]]:
        """Return the command and the state interfaces, each sorted by name."""
        return self.resources.list_interfaces()

    # Controllers

    def list_controllers(self) -> tuple[ControllerStatus, ...]:
        """Return every loaded controller, the newest first, but along the chains."""
        return tuple(c.status(self._chain.connections(c)) for c in self._chain.in_order())

    def controller_runs(self) -> tuple[tuple[ControllerStatus, RunRecord], ...]:
        """Return every loaded controller with the record of its updates, the newest first."""
        return tuple((s, self._controllers[s.name].runs) for s in self.list_controllers())

    def load_controller(
        self, controller: Controller[Any], type_name: str, fallback_names: Sequence[str] = ()
    ) -> None:
        """Take a new controller in; it is unconfigured."""
        name = controller.name
        if name in self._controllers:
            raise ControllerManagerError(
                f"A controller named '{name}' was already loaded inside the controller manager"
            )
        if name in fallback_names:
            raise ControllerManagerError(f"controller '{name}' cannot be its own fallback")
        managed = ManagedController(
            controller, type_name, tuple(fallback_names), self.update_rate_hz, self._supervision
        )
        self._controllers[name] = managed
        self._activity_changed()

    def configure_controller(
        self, name: str, parameters: object, requested_rate_hz: int = 0
    ) -> None:
        """Configure a controller; one that is inactive is cleaned up first.

        Args:
            name: of a loaded controller, unconfigured or inactive.
            parameters: instance of its `parameters_type`.
            requested_rate_hz: its own update rate; 0 for the manager's.
        """
        controller = self._find(name, "configure")
        if controller.state is LifecycleState.INACTIVE:
            self._clean_up(controller)
        if controller.state is not LifecycleState.UNCONFIGURED:
            raise ControllerManagerError(
                f"Controller '{name}' can not be configured from '{controller.state.label}' state."
            )
        controller.set_update_rate(requested_rate_hz)
        reason = self._lifecycle.configure(controller, parameters)
        self._activity_changed()
        if reason:
            raise ControllerManagerError(f"controller '{name}' was not configured: {reason}")

    def cleanup_controller(self, name: str) -> None:
        """Take a controller back to unconfigured; nothing to do where it is."""
        controller = self._find(name, "clean up")
        if controller.state in (LifecycleState.ACTIVE, LifecycleState.FINALIZED):
            raise ControllerManagerError(
                f"Controller '{name}' can not be cleaned-up from '{controller.state.label}' state."
            )
        if controller.state is LifecycleState.INACTIVE:
            self._clean_up(controller)

    def unload_controller(self, name: str) -> None:
        """Clean a controller up, shut it down and forget it."""
        controller = self._find(name, "unload")
        if controller.is_active:
            raise ControllerManagerError(
                f"Could not unload controller with name '{name}' because it is still active"
            )
        if controller.state is LifecycleState.INACTIVE:
            self._lifecycle.clean_up(controller)
        self._lifecycle.shut_down(controller)
        del self._controllers[name]
        self._activity_changed()

    def switch_controller(self, request: SwitchRequest) -> SwitchResult:
        """Deactivate and activate controllers in one go; never raises, the result says it all."""
        with self._following():
            return self._switcher.switch(request)

    def shutdown(self) -> None:
        """Deactivate and finalize every controller, then every component."""
        self._switcher.deactivate([c for c in self._chain.in_order() if c.is_active])
        self._select_active()
        for controller in self._controllers.values():
            if controller.state is LifecycleState.INACTIVE:
                self._lifecycle.clean_up(controller)
            if controller.state is not LifecycleState.FINALIZED:
                self._lifecycle.shut_down(controller)
        self._keeper.shut_down()
        self._activity_changed()

    def _clean_up(self, controller: ManagedController) -> None:
        reason = self._lifecycle.clean_up(controller)
        self._activity_changed()
        if reason:
            raise ControllerManagerError(
                f"controller '{controller.name}' was not cleaned up: {reason}"
            )

    def _find(self, name: str, action: str) -> ManagedController:
        controller = self._controllers.get(name)
        if controller is None:
            raise ControllerManagerError(
                f"Could not {action} controller with name '{name}' because no controller with "
                f"this name exists; loaded: {', '.join(self._controllers) or 'none'}"
            )
        return controller

    def _replace_failed(self, failed: Sequence[ManagedController]) -> None:
        self._switcher.replace_failed(failed)
        self._select_active()

    def _stop_troubled(self, trouble: Sequence[Trouble], exchange: str) -> None:
        self._keeper.stop_troubled(trouble, exchange)
        self._select_active()

    def _resolve_inactive(self) -> None:
        """Let configured controllers see what is available now."""
        for controller in self._controllers.values():
            if controller.state is LifecycleState.INACTIVE:
                self._lifecycle.resolve(controller)

    @contextmanager
    def _following(self) -> Iterator[None]:
        """Go by what has changed in the end; nothing has where a request was refused."""
        before = self._changes, self._component_states()
        try:
            yield
        finally:
            if before != (self._changes, self._component_states()):
                self._select_active()

    def _component_states(self) -> list[LifecycleState]:
        return [component.state for component in self.resources.components.values()]

    def _select_active(self) -> None:
        active = [c for c in self._chain.in_order() if c.is_active]
        self._commanding = self._chain.with_read(c for c in active if c.commands)
        self._broadcasting = tuple(c for c in active if c not in self._commanding)
        if self._limiter is not None:
            self._limiter.claimed({name for c in active for name in c.commands})
        self._resolve_inactive()
        self._activity_changed()

    def _controller_transitioned(
        self, name: str, transition: Transition, start: LifecycleState, end: LifecycleState
    ) -> None:
        self._changes += end is not start
        for observer in self._observers:
            observer.controller_transitioned(name, transition, start, end)

    def _activity_changed(self) -> None:
        for observer in self._observers:
            observer.activity_changed()
