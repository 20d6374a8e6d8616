"""The loaded controllers: their states, rates and interfaces, and the order in which they run."""

import logging
from collections.abc import Callable, Iterable, Iterator
from math import nan
from typing import Any

from arm_control.controllers.controller import ChainableController, Controller, ReturnType
from arm_control.controllers.exported_interfaces import ExportedInterfaces
from arm_control.errors import ControllerManagerError
from arm_control.hardware.resource_manager import ResourceManager
from arm_control.lifecycle import LifecycleState
from arm_control.loop.schedule import Cadence, achievable_rate_hz
from arm_control.loop.supervision import RunSupervision, failure_of
from arm_control.status import ChainConnection, ControllerStatus

logger = logging.getLogger("controller_manager")

# Looked up once: in Python 3.11 a member of an enum takes as long as a call.
_OK = ReturnType.OK


class ManagedController:
    """A controller and what the manager knows about it. Loop thread only.

    Attributes:
        controller: the controller itself.
        type_name: its ros2_control type string.
        fallback_names: controllers to activate in its place when an update fails.
        state: its life-cycle state.
        requested_rate_hz: the requested update rate; 0 for the manager's.
        commands: full names of the command interfaces it requests; empty while unconfigured.
        states: full names of the state interfaces it requests; empty while unconfigured.
        named_states: `states` if it requests them by name; else empty.
        runs: its latest updates, with the periods passed to them.
    """

    def __init__(
        self,
        controller: Controller[Any],
        type_name: str,
        fallback_names: tuple[str, ...],
        manager_rate_hz: int,
        supervision: RunSupervision | None = None,
    ) -> None:
        self.controller = controller
        self.type_name = type_name
        self.fallback_names = fallback_names
        self.state = LifecycleState.UNCONFIGURED
        self.requested_rate_hz = 0
        self.commands: tuple[str, ...] = ()
        self.states: tuple[str, ...] = ()
        self.named_states: tuple[str, ...] = ()
        self._manager_rate_hz = manager_rate_hz
        self._cadence = Cadence(manager_rate_hz, manager_rate_hz)
        supervision = supervision or RunSupervision()
        self.runs = supervision.record()
        self._now_s = supervision.now_s
        self._on_exception = supervision.on_exception

    @property
    def name(self) -> str:
        """The controller's name."""
        return self.controller.name

    @property
    def update_rate_hz(self) -> int:
        """Its actual update rate."""
        return self._cadence.rate_hz

    @property
    def is_active(self) -> bool:
        """Whether it is being updated."""
        return self.state is LifecycleState.ACTIVE

    @property
    def is_chained(self) -> bool:
        """Whether another controller commands its references."""
        controller = self.controller
        return isinstance(controller, ChainableController) and controller.is_chained

    def set_chained(self, is_chained: bool) -> None:
        """Set the chained mode; has no effect if the controller is not chainable."""
        controller = self.controller
        if not isinstance(controller, ChainableController) or is_chained == controller.is_chained:
            return
        controller.is_chained = is_chained
        reason = failure_of(
            lambda: controller.on_set_chained_mode(is_chained),
            f"on_set_chained_mode of controller '{self.name}'",
        )
        if reason:
            logger.error("%s", reason)

    def set_update_rate(self, requested_hz: int) -> None:
        """Set the rate to the nearest divisor of the manager's; 0 means the manager's."""
        manager_rate_hz = self._manager_rate_hz
        self.requested_rate_hz = requested_hz
        rate_hz = achievable_rate_hz(f"controller '{self.name}'", requested_hz, manager_rate_hz)
        self._cadence = Cadence(rate_hz, manager_rate_hz)

    def resolve_interfaces(self, resources: ResourceManager) -> None:
        """Find the interfaces that the controller requests among those that exist now."""
        self.commands = self.controller.command_interface_configuration().resolve(
            resources.available_commands()
        )
        wanted = self.controller.state_interface_configuration()
        self.states = wanted.resolve(resources.available_states())
        self.named_states = self.states if wanted.is_by_name else ()

    def forget_interfaces(self) -> None:
        """Clear the interfaces."""
        self.commands = self.states = self.named_states = ()

    def forget_references(self) -> None:
        """Reset the references of a chainable controller to NaN."""
        if isinstance(self.controller, ChainableController):
            self.controller.references[:] = nan

    def restart_cadence(self) -> None:
        """Treat the next cycle as the first: it runs at once, with the nominal period."""
        self._cadence.restart()
        self.runs.clear()

    def save_state(self) -> Any:
        """Return when it runs next, and the controller's state."""
        return self._cadence.save_state(), self.controller.save_state()

    def load_state(self, state: Any) -> None:
        """Continue from a saved state."""
        cadence, controller = state
        self._cadence.load_state(cadence)
        self.controller.load_state(controller)

    @property
    def is_halted(self) -> bool:
        """Whether it does not run although it is active, see `RunningControllers`."""
        return bool(self.controller.halted_by)

    def halt(self, reason: str) -> None:
        """Call its `on_deactivate`, but keep its life-cycle state and its interfaces."""
        self.controller.halted_by = reason
        failure = failure_of(
            self.controller.on_deactivate, f"on_deactivate of controller '{self.name}'"
        )
        if failure:
            logger.error("controller '%s' did not stop by itself: %s", self.name, failure)

    def go_on(self) -> bool:
        """Call its `on_activate`, after `halt`; return whether it can continue."""
        if not self.is_halted:
            return True
        self.controller.halted_by = ""
        self.restart_cadence()
        self.forget_references()
        failure = failure_of(
            self.controller.on_activate, f"on_activate of controller '{self.name}'"
        )
        if failure:
            logger.error("controller '%s' cannot continue: %s", self.name, failure)
        return not failure

    def run(self, time_s: float, period_s: float) -> bool:
        """Update the controller if it is due; return False if the update failed."""
        cadence = self._cadence
        due_s = cadence.due_period_s(time_s, period_s) if cadence.skips else period_s
        if due_s is None:
            return True
        began_s = self._now_s()
        try:
            outcome = self.controller.update(time_s, due_s)
        except KeyboardInterrupt:
            raise
        except BaseException as error:
            # A controller is user code and may raise even SystemExit. By default the manager
            # deactivates it and goes on.
            self._on_exception(f"controller '{self.name}' raised in its update", error)
            return False
        self.runs.add_period(due_s)
        self.runs.add_duration(self._now_s() - began_s)
        return outcome is _OK

    def status(self, connections: tuple[ChainConnection, ...] = ()) -> ControllerStatus:
        """Return a snapshot for the list services, with the references that it commands."""
        exports = self._exports()
        return ControllerStatus(
            name=self.name,
            type_name=self.type_name,
            state=self.state,
            update_rate_hz=self.update_rate_hz,
            claimed_interfaces=self.commands if self.is_active else (),
            required_command_interfaces=self.commands,
            required_state_interfaces=self.states,
            is_chainable=isinstance(self.controller, ChainableController),
            is_chained=self.is_chained,
            reference_interfaces=exports.reference_names() if exports else (),
            exported_state_interfaces=exports.exported_state_names() if exports else (),
            chain_connections=connections,
            halted_by=self.controller.halted_by,
        )

    def _exports(self) -> ChainableController[Any] | None:
        """Return the controller if it is chainable and configured."""
        configured = self.state in (LifecycleState.INACTIVE, LifecycleState.ACTIVE)
        controller = self.controller
        return controller if configured and isinstance(controller, ChainableController) else None


def unknown_controller(name: str, action: str) -> str:
    """Return the sentence of ros2_control for a controller that is not loaded."""
    return (
        f"Could not {action} controller with name '{name}' because no controller with this name "
        "exists"
    )


class LoadedControllers(dict[str, ManagedController]):
    """The loaded controllers by name in the order of their loading, and who commands whom.

    Loop thread only. A controller *precedes* those whose references it commands or whose exported
    states it requests by name; these *follow* it. A controller that reads all available states
    depends on none.
    """

    def __init__(self, exported: ExportedInterfaces) -> None:
        """Start empty; `exported` has the interfaces that the controllers export."""
        super().__init__()
        self._exported = exported

    def find(self, name: str, action: str) -> ManagedController:
        """Return a controller.

        Raises:
            ControllerManagerError: there is none of this name, so the action is impossible.
        """
        controller = self.get(name)
        if controller is None:
            loaded = ", ".join(self) or "none"
            raise ControllerManagerError(f"{unknown_controller(name, action)}; loaded: {loaded}")
        return controller

    def active(self) -> list[ManagedController]:
        """Return the active ones."""
        return [controller for controller in self.values() if controller.is_active]

    def commanded_by(self, controller: ManagedController) -> tuple[ManagedController, ...]:
        """Return the controllers whose references it commands."""
        return self._named(map(self._exported.reference_owner, controller.commands))

    def read_by(self, controller: ManagedController) -> tuple[ManagedController, ...]:
        """Return the controllers whose exported states it reads, requested by name or not."""
        return self._named(map(self._exported.state_owner, controller.states))

    def following(self, controller: ManagedController) -> tuple[ManagedController, ...]:
        """Return the controllers that follow it directly."""
        needed = self._named(map(self._exported.state_owner, controller.named_states))
        return tuple(dict.fromkeys((*self.commanded_by(controller), *needed)))

    def preceding(self, controller: ManagedController) -> tuple[ManagedController, ...]:
        """Return the controllers that precede it directly."""
        return tuple(c for c in self.values() if controller in self.following(c))

    def is_commanded(self, controller: ManagedController, by: Iterable[ManagedController]) -> bool:
        """Return whether one of these commands the controller's references."""
        return any(controller in self.commanded_by(other) for other in by)

    def connections(self, controller: ManagedController) -> tuple[ChainConnection, ...]:
        """Return the references that a controller commands, by the controller that exports them."""
        return tuple(
            ChainConnection(
                other.name,
                tuple(
                    name.removeprefix(f"{other.name}/")
                    for name in controller.commands
                    if self._exported.reference_owner(name) == other.name
                ),
            )
            for other in self.commanded_by(controller)
        )

    def in_order(self) -> tuple[ManagedController, ...]:
        """Return all controllers in their order of execution: newest first, but along the chains.

        A controller runs before those that it commands. A controller that exports states runs
        before those that read them, unless the reader commands it.
        """
        if not self._exported.references() and not self._exported.states():
            return self._newest_first()
        return _depth_first(self._newest_first(), self._earlier)

    def from_below(self, controllers: Iterable[ManagedController]) -> tuple[ManagedController, ...]:
        """Return these with following controllers first; otherwise the order is kept.

        They are started in this order, and stopped in the reverse order.
        """
        wanted = tuple(controllers)
        return _depth_first(wanted, lambda c: (f for f in self.following(c) if f in wanted))

    def with_preceding(
        self, controllers: Iterable[ManagedController]
    ) -> tuple[ManagedController, ...]:
        """Return these and all active ones that precede them."""
        return self._closure(controllers, self.preceding)

    def with_commands(
        self, controllers: Iterable[ManagedController]
    ) -> tuple[ManagedController, ...]:
        """Return these and all active ones that command them or that they command, at any depth."""
        every = tuple(self.values())

        def neighbours(controller: ManagedController) -> Iterator[ManagedController]:
            yield from self.commanded_by(controller)
            yield from (c for c in every if controller in self.commanded_by(c))

        return self._closure(controllers, neighbours)

    def with_read(self, controllers: Iterable[ManagedController]) -> tuple[ManagedController, ...]:
        """Return these and all active ones whose exported states they read."""
        return self._closure(controllers, self.read_by)

    def with_group(self, controllers: Iterable[ManagedController]) -> tuple[ManagedController, ...]:
        """Return these and all active ones connected with them, directly or not."""
        return self._closure(controllers, lambda c: (*self.preceding(c), *self.following(c)))

    def _newest_first(self) -> tuple[ManagedController, ...]:
        return tuple(self.values())[::-1]

    def _earlier(self, controller: ManagedController) -> Iterator[ManagedController]:
        for other in self._newest_first():
            if controller in self.commanded_by(other):
                yield other
        for other in self.read_by(controller):
            if not self._leads_to(controller, other):
                yield other

    def _leads_to(self, controller: ManagedController, goal: ManagedController) -> bool:
        """Return whether one controller's commands reach the other, directly or through others."""
        waiting, seen = [controller], {controller.name}
        while waiting:
            for other in self.commanded_by(waiting.pop()):
                if other is goal:
                    return True
                if other.name not in seen:
                    seen.add(other.name)
                    waiting.append(other)
        return False

    def _closure(
        self,
        controllers: Iterable[ManagedController],
        neighbours: Callable[[ManagedController], Iterable[ManagedController]],
    ) -> tuple[ManagedController, ...]:
        reached = {controller.name for controller in controllers}
        waiting = [self[name] for name in reached]
        while waiting:
            for other in neighbours(waiting.pop()):
                if other.is_active and other.name not in reached:
                    reached.add(other.name)
                    waiting.append(other)
        return tuple(c for c in self.in_order() if c.name in reached)

    def _named(self, names: Iterable[str | None]) -> tuple[ManagedController, ...]:
        return tuple(
            self[name] for name in dict.fromkeys(names) if name is not None and name in self
        )


def _depth_first(
    controllers: Iterable[ManagedController],
    earlier: Callable[[ManagedController], Iterable[ManagedController]],
) -> tuple[ManagedController, ...]:
    """Return controllers, each after those that `earlier` returns for it; circles are cut open."""
    ordered: dict[str, ManagedController] = {}
    visited: set[str] = set()

    def visit(controller: ManagedController) -> None:
        if controller.name not in visited:
            visited.add(controller.name)
            for other in earlier(controller):
                visit(other)
            ordered[controller.name] = controller

    for controller in controllers:
        visit(controller)
    return tuple(ordered.values())
