"""A loaded controller in the manager's care: its state, its rate, its interfaces."""

import logging
from math import nan
from typing import Any

from arm_control.cadence import Cadence, possible_rate_hz
from arm_control.chainable_controller import ChainableController
from arm_control.controller import Controller, ReturnType
from arm_control.guarded import failure_of
from arm_control.lifecycle import LifecycleState
from arm_control.resource_manager import ResourceManager
from arm_control.run_supervision import RunSupervision
from arm_control.status import ChainConnection, ControllerStatus

logger = logging.getLogger(__name__)


class ManagedController:
    """A controller and what the manager knows about it. Loop thread only.

    Attributes:
        controller: the controller itself.
        type_name: its ros2_control type string.
        fallback_names: controllers to activate in its place when an update fails.
        state: of its life cycle.
        commands: full names of the command interfaces it asks for; empty while unconfigured.
        states: full names of the state interfaces it asks for; empty while unconfigured.
        named_states: these, where it asks for them by name; empty where it takes what there is.
        runs: its latest updates, with the periods that they were told.
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
        """How often it really runs."""
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
        """Say whether another controller commands its references; for a chainable one."""
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
        """Choose the rate nearest to the one asked for that divides the manager's; 0 = that."""
        manager_rate_hz = self._manager_rate_hz
        rate_hz = possible_rate_hz(f"controller '{self.name}'", requested_hz, manager_rate_hz)
        self._cadence = Cadence(rate_hz, manager_rate_hz)

    def resolve_interfaces(self, resources: ResourceManager) -> None:
        """Ask the controller what it wants, and look up what that means now."""
        self.commands = self.controller.command_interface_configuration().resolve(
            resources.available_commands()
        )
        wanted = self.controller.state_interface_configuration()
        self.states = wanted.resolve(resources.available_states())
        self.named_states = self.states if wanted.is_by_name else ()

    def forget_interfaces(self) -> None:
        """Ask for nothing any more."""
        self.commands = self.states = self.named_states = ()

    def forget_references(self) -> None:
        """Let a chainable controller begin with nothing to follow."""
        if isinstance(self.controller, ChainableController):
            self.controller.references[:] = nan

    def restart_cadence(self) -> None:
        """Let the next cycle be the first: it runs at once, with the nominal period."""
        self._cadence.restart()
        self.runs.clear()

    def run(self, time_s: float, period_s: float) -> bool:
        """Update the controller if its cycle has come; return False where that failed."""
        due_s = self._cadence.due_period_s(time_s, period_s)
        if due_s is None:
            return True
        began_s = self._now_s()
        try:
            outcome = self.controller.update(time_s, due_s)
        except KeyboardInterrupt:
            raise
        except BaseException as error:
            # A controller is outside code, so even SystemExit may come out of it; as a rule the
            # manager deactivates it and goes on.
            self._on_exception(f"controller '{self.name}' raised in its update", error)
            return False
        self.runs.add(due_s, self._now_s() - began_s)
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
        )

    def _exports(self) -> ChainableController[Any] | None:
        """Return the controller where it is chainable and configured."""
        configured = self.state in (LifecycleState.INACTIVE, LifecycleState.ACTIVE)
        controller = self.controller
        return controller if configured and isinstance(controller, ChainableController) else None
