"""Loads, configures, switches and updates controllers on top of hardware components."""

import logging
from collections.abc import Iterable, Iterator, Mapping, Sequence
from contextlib import contextmanager
from math import nan
from types import MappingProxyType
from typing import Any, Protocol

from arm_control.controllers.controller import Controller
from arm_control.errors import ControllerError, ControllerManagerError
from arm_control.hardware.command_limits import CommandLimiter
from arm_control.hardware.driver import Hardware
from arm_control.hardware.joint_limits import JointLimits, read_joint_limits
from arm_control.hardware.resource_manager import HardwareFault, ResourceManager
from arm_control.lifecycle import LifecycleState, Transition
from arm_control.loop.clock import Clock
from arm_control.loop.supervision import RunRecord, RunSupervision, log_failure, raise_failure
from arm_control.manager.controller_switcher import DEFAULT_NAME, ControllerSwitcher
from arm_control.manager.hardware_lifecycle import HardwareLifecycle
from arm_control.manager.loaded_controllers import LoadedControllers, ManagedController
from arm_control.manager.manager_state import ManagerState
from arm_control.manager.running_controllers import LATCHED, RunningControllers
from arm_control.manager.settings import ManagerPolicy, ManagerSettings
from arm_control.manager.switch_planner import SwitchRequest, SwitchResult
from arm_control.run_inputs import InputGate, run_input, run_input_noted_as
from arm_control.status import ControllerStatus, HardwareComponentStatus, InterfaceStatus
from arm_description.urdf.description import Description

STATISTICS_S = 5
"""The statistics cover the last few seconds, so that a stall shows for a while, not for ever."""

DEFAULT_POLICY = ManagerPolicy()
NO_LIMITS: Mapping[str, JointLimits] = MappingProxyType({})

logger = logging.getLogger("controller_manager")


class ManagerObserver(Protocol):
    """Is told of changes on the loop thread; it must return quickly and must not raise."""

    def controller_transitioned(
        self, name: str, transition: Transition, start: LifecycleState, end: LifecycleState
    ) -> None:
        """A controller attempted a transition; `end` is the transition's goal if it succeeded."""
        ...

    def activity_changed(self) -> None:
        """The set of controllers or components, or the state of one of them, has changed."""
        ...


def _describe_load(arguments: Mapping[str, Any]) -> Mapping[str, object]:
    """Return what a recording stores for `load_controller`: the name, not the controller."""
    return {**arguments, "controller": arguments["controller"].name}


class ControllerManager:
    """Runs controllers on hardware components, one tick at a time, like ros2_control's manager.

    Single-threaded: only the loop thread (or the only thread of a program) may call its methods.
    A tick calls `update` and `write`, then, after the world has advanced, `read` and `publish`, so
    that commands take effect before the resulting state is published.

    Methods that change something raise `ControllerManagerError` with the reason for a refusal.

    Attributes:
        name: fully qualified name of its node.
        update_rate_hz: ticks per second.
        resources: the components, and the arrays of states and commands.
        updates: its latest updates, with the periods of its cycles.
        state: saves, restores and resets its controllers and components.
        input_gate: notes the inputs while a run is recorded; see `set_input_gate`.
    """

    input_gate: InputGate | None = None

    def __init__(
        self,
        hardware: Sequence[Hardware],
        update_rate_hz: int,
        policy: ManagerPolicy = DEFAULT_POLICY,
        limits: Mapping[str, JointLimits] = NO_LIMITS,
        name: str = DEFAULT_NAME,
    ) -> None:
        """Take ownership of the components, which stay unconfigured until `bring_up`.

        Args:
            hardware: the components' drivers.
            update_rate_hz: ticks per second.
            policy: the user's choices.
            limits: by joint; the commands of these joints are clamped.
            name: fully qualified name of its node, for command lines in messages.

        Raises:
            ControllerManagerError: the rate is not positive, or names are used twice.
        """
        if update_rate_hz < 1:
            raise ControllerManagerError(f"update_rate must be positive, not {update_rate_hz} Hz")
        self.name = name
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
        self._loaded = loaded = LoadedControllers(self.resources.exported)
        self._switcher = ControllerSwitcher(
            loaded, self.resources, self._controller_transitioned, name
        )
        self._hardware = HardwareLifecycle(loaded, self.resources, self._switcher, policy)
        self._active = RunningControllers(
            loaded, self.resources, self._switcher, self._limiter, name
        )
        self.state = ManagerState(
            loaded,
            self.resources,
            self._switcher,
            self._hardware,
            self._active,
            self._limiter,
            self._tracking_changes,
        )
        self._observers: list[ManagerObserver] = []
        self._changes = 0

    def add_observer(self, observer: ManagerObserver) -> None:
        """Notify this observer of every change from now on."""
        self._observers.append(observer)

    def set_input_gate(self, gate: InputGate | None) -> None:
        """Route the inputs of the manager and its controllers through a gate; None removes it."""
        self.input_gate = gate
        for managed in self._loaded.values():
            managed.controller.input_gate = gate

    @property
    def controllers(self) -> Mapping[str, ManagedController]:
        """The loaded controllers by name, in the order in which they were loaded."""
        return self._loaded

    # One tick

    def update(self, time_s: float, period_s: float) -> None:
        """Update the controllers with commands, and those whose exported states they read."""
        began_s = self._supervision.now_s()
        if self._active.is_stopped:
            self._active.hold()
        elif failed := [c for c in self._active.running if not c.run(time_s, period_s)]:
            self._replace_failed(failed)
        self.updates.add_period(period_s)
        self.updates.add_duration(self._supervision.now_s() - began_s)

    def write(self, time_s: float, period_s: float) -> None:
        """Write the commands, clamped to their limits, to the hardware."""
        if self._limiter is not None:
            self._limiter.enforce(period_s)
        faults = self.resources.write(time_s, period_s)
        if faults:
            self._stop_faulty(faults, "write")

    def read(self, time_s: float, period_s: float) -> None:
        """Read the states from the hardware."""
        faults = self.resources.read(time_s, period_s)
        if faults:
            self._stop_faulty(faults, "read")

    def publish(self, time_s: float, period_s: float) -> None:
        """Update the other controllers: those that only read states, such as broadcasters."""
        failed = [c for c in self._active.broadcasting if not c.run(time_s, period_s)]
        if failed:
            self._replace_failed(failed)

    # Emergency stop

    @property
    def emergency_stopped(self) -> bool:
        """Whether an emergency stop holds everything; any thread."""
        return self._active.is_stopped

    @run_input
    def set_emergency_stop(self, engaged: bool) -> bool:
        """Engage or release the emergency stop; return False if that changes nothing."""
        if engaged == self._active.is_stopped:
            return False
        self._active.set_emergency_stop(engaged)
        self._select_active()
        return True

    # Hardware

    def bring_up(self, unconfigured: Iterable[str] = (), inactive: Iterable[str] = ()) -> None:
        """Bring every component to its initial state, which is active unless named; read once.

        The components of a group are all configured before any of them is activated; if one fails,
        all are cleaned up.

        Raises:
            ControllerManagerError: a name is unknown, or a component did not reach its state and
                the policy makes that an error.
        """
        try:
            self._hardware.bring_up(unconfigured, inactive)
        finally:
            self._select_active()
        self.read(0.0, 1.0 / self.update_rate_hz)
        for component in self.resources.components.values():
            component.restart_cadence()

    @run_input
    def set_hardware_component_state(self, name: str, target: LifecycleState) -> None:
        """Bring a component to a state; controllers whose interfaces disappear are stopped."""
        with self._tracking_changes():
            self._hardware.set_state(name, target)

    def list_hardware_components(self) -> tuple[HardwareComponentStatus, ...]:
        """Return every component."""
        return self.resources.list_components()

    def list_hardware_interfaces(
        self,
    ) -> tuple[tuple[InterfaceStatus, ...], tuple[InterfaceStatus, ...]]:
        """Return the command and the state interfaces, each sorted by name."""
        return self.resources.list_interfaces()

    # Controllers

    def list_controllers(self) -> tuple[ControllerStatus, ...]:
        """Return every loaded controller in order of execution: newest first, along the chains."""
        return tuple(c.status(self._loaded.connections(c)) for c in self._loaded.in_order())

    def controller_runs(self) -> tuple[tuple[ControllerStatus, RunRecord], ...]:
        """Return every loaded controller with the record of its updates, the newest first."""
        return tuple((s, self._loaded[s.name].runs) for s in self.list_controllers())

    @run_input_noted_as(_describe_load)
    def load_controller(
        self, controller: Controller[Any], type_name: str, fallback_names: Sequence[str] = ()
    ) -> None:
        """Add a new, unconfigured controller."""
        name = controller.name
        if name in self._loaded:
            raise ControllerManagerError(
                f"A controller named '{name}' was already loaded inside the controller manager"
            )
        if name in fallback_names:
            raise ControllerManagerError(f"controller '{name}' cannot be its own fallback")
        managed = ManagedController(
            controller, type_name, tuple(fallback_names), self.update_rate_hz, self._supervision
        )
        controller.input_gate = self.input_gate
        self._loaded[name] = managed
        self._activity_changed()

    @run_input
    def configure_controller(
        self, name: str, parameters: object, requested_rate_hz: int = 0
    ) -> None:
        """Configure a controller; one that is inactive is cleaned up first.

        Args:
            name: name of a loaded controller, unconfigured or inactive.
            parameters: instance of its `parameters_type`.
            requested_rate_hz: its update rate; 0 for the manager's.
        """
        controller = self._loaded.find(name, "configure")
        if controller.state is LifecycleState.INACTIVE:
            self._clean_up(controller)
        if controller.state is not LifecycleState.UNCONFIGURED:
            raise ControllerManagerError(
                f"Controller '{name}' can not be configured from '{controller.state.label}' state."
            )
        controller.set_update_rate(requested_rate_hz)
        reason = self._switcher.configure(controller, parameters)
        self._activity_changed()
        if reason:
            raise ControllerManagerError(f"controller '{name}' was not configured: {reason}")

    @run_input
    def cleanup_controller(self, name: str) -> None:
        """Return a controller to unconfigured; has no effect if it already is."""
        controller = self._loaded.find(name, "clean up")
        if controller.state in (LifecycleState.ACTIVE, LifecycleState.FINALIZED):
            raise ControllerManagerError(
                f"Controller '{name}' can not be cleaned-up from '{controller.state.label}' state."
            )
        if controller.state is LifecycleState.INACTIVE:
            self._clean_up(controller)

    @run_input
    def fail_controller(self, name: str, reason: str) -> None:
        """Treat an active controller as if its update had raised."""
        self._supervision.on_exception(
            f"controller '{name}' raised in its update", ControllerError(reason)
        )
        self._replace_failed([self._loaded.find(name, "fail")])

    @run_input
    def unload_controller(self, name: str) -> None:
        """Clean up, finalize and remove a controller."""
        controller = self._loaded.find(name, "unload")
        if controller.is_active:
            raise ControllerManagerError(
                f"Could not unload controller with name '{name}' because it is still active"
            )
        if controller.state is LifecycleState.INACTIVE:
            self._switcher.clean_up(controller)
        self._switcher.shut_down(controller)
        del self._loaded[name]
        self._activity_changed()

    @run_input
    def switch_controller(self, request: SwitchRequest) -> SwitchResult:
        """Deactivate and activate controllers in one step; never raises, see the result."""
        if request.activate and self._active.is_stopped:
            logger.error("no controller is switched: %s", LATCHED)
            return SwitchResult(False, LATCHED)
        with self._tracking_changes():
            return self._switcher.switch(request)

    @run_input
    def shutdown(self) -> None:
        """Deactivate and finalize every controller, then every component."""
        self._switcher.deactivate([c for c in self._loaded.in_order() if c.is_active])
        self._select_active()
        for controller in self._loaded.values():
            if controller.state is LifecycleState.INACTIVE:
                self._switcher.clean_up(controller)
            if controller.state is not LifecycleState.FINALIZED:
                self._switcher.shut_down(controller)
        self._hardware.shut_down()
        self._activity_changed()

    def _clean_up(self, controller: ManagedController) -> None:
        reason = self._switcher.clean_up(controller)
        self._activity_changed()
        if reason:
            raise ControllerManagerError(
                f"controller '{controller.name}' was not cleaned up: {reason}"
            )

    def _replace_failed(self, failed: Sequence[ManagedController]) -> None:
        self._switcher.replace_failed(failed)
        self._select_active()

    def _stop_faulty(self, faults: Sequence[HardwareFault], exchange: str) -> None:
        self._hardware.stop_faulty(faults, exchange)
        self._select_active()

    @contextmanager
    def _tracking_changes(self) -> Iterator[None]:
        """Update the lists of active controllers afterwards, if anything has changed."""
        before = self._activity()
        try:
            yield
        finally:
            if before != self._activity():
                self._select_active()

    def _activity(self) -> tuple[int, list[str], list[LifecycleState]]:
        """Return the data that decide which controllers run and in which order."""
        components = self.resources.components.values()
        return self._changes, list(self._loaded), [c.state for c in components]

    def _select_active(self) -> None:
        """Find which controllers run now, and the interfaces of inactive ones that exist now."""
        self._active.refresh()
        for controller in self._loaded.values():
            if controller.state is LifecycleState.INACTIVE:
                self._switcher.resolve(controller)
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


def configured_manager(
    hardware: Sequence[Hardware],
    settings: ManagerSettings,
    robot_description: Description,
    name: str,
) -> ControllerManager:
    """Return a manager whose components are still unconfigured; see `bring_up`.

    The description has the command limits; `name` is the full name of the node, for command lines
    in messages.

    Raises:
        ArmControlError: names are used twice, or requested limits cannot be read.
    """
    limited = settings.enforce_command_limits
    return ControllerManager(
        hardware,
        settings.update_rate,
        settings.policy,
        read_joint_limits(robot_description) if limited else NO_LIMITS,
        name,
    )


def bring_up(manager: ControllerManager, settings: ManagerSettings) -> None:
    """Bring the components to their initial states.

    Raises:
        ArmControlError: one of them fails, and the settings make that an error.
    """
    initial = settings.hardware_components_initial_state
    manager.bring_up(initial.unconfigured, initial.inactive)


class ControlCycle:
    """Reads states, updates controllers, writes commands, runs broadcasters. Loop thread only.

    Commands are written before the broadcasters run, so that hardware need not wait for publishing.
    """

    def __init__(
        self, manager: ControllerManager, clock: Clock, ticker: Clock | None = None
    ) -> None:
        """Prepare the cycle.

        `ticker` measures the periods if `clock` may be set.
        """
        self._manager = manager
        self._now_s = clock.now_s
        self._tick_s = (ticker or clock).now_s
        self._nominal_period_s = 1.0 / manager.update_rate_hz
        self._last_s = nan

    def __call__(self) -> None:
        """Run one cycle; its period is the time since the last one.

        The period is the nominal one for the first cycle, and if the ticker has not advanced.
        """
        manager, time_s, tick_s = self._manager, self._now_s(), self._tick_s()
        period_s = tick_s - self._last_s
        if not period_s > 0.0:
            period_s = self._nominal_period_s
        self._last_s = tick_s
        manager.read(time_s, period_s)
        manager.update(time_s, period_s)
        manager.write(time_s, period_s)
        manager.publish(time_s, period_s)
