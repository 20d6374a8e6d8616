"""A loaded controller with its state, rate and interfaces."""

import logging
from math import nan
from typing import Any

from arm_control.controllers.controller import ChainableController, Controller, ReturnType
from arm_control.hardware.resource_manager import ResourceManager
from arm_control.lifecycle import LifecycleState
from arm_control.loop.cadence import Cadence, achievable_rate_hz
from arm_control.loop.supervision import RunSupervision, failure_of
from arm_control.status import ChainConnection, ControllerStatus

logger = logging.getLogger("controller_manager")


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
        """Whether it does not run although it is active, see `ControllerHalts`."""
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
        return outcome is ReturnType.OK

    def status(self, connections: tuple[ChainConnection, ...] = ()) -> ControllerStatus:
        """Return a snapshot for the list services.

        Args:
            connections: the references of others that it commands.
        """
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
