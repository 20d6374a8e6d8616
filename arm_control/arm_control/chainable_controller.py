"""A controller that other controllers may command and read."""

from abc import abstractmethod
from typing import TypeVar

import numpy as np

from arm_control.controller import Controller, ControllerContext, ReturnType

ParametersT = TypeVar("ParametersT")


class ChainableController(Controller[ParametersT]):
    """Exports references for others to command, and states for others to read.

    Their full names begin with the controller's own: 'pid/j0/position'. While another controller
    commands the references (chained mode) `update_references` is not called.

    Attributes:
        references: what to follow, shape (number of `reference_names`,); NaN at activation.
            Leaving chained mode they keep their last values.
        exported_states: for others to read, shape (number of `exported_state_names`,).
        is_chained: whether another controller commands the references.
    """

    def __init__(self, context: ControllerContext) -> None:
        super().__init__(context)
        self.references = np.empty(0)
        self.exported_states = np.empty(0)
        self.is_chained = False

    def reference_names(self) -> tuple[str, ...]:
        """Return the references without the controller's name; asked after `on_configure`."""
        return ()

    def exported_state_names(self) -> tuple[str, ...]:
        """Return the exported states without the controller's name; after `on_configure`."""
        return ()

    @abstractmethod
    def update_references(self, time_s: float, period_s: float) -> ReturnType:
        """Write `references` from what came in by topic; see `Controller.update`."""

    @abstractmethod
    def update_commands(self, time_s: float, period_s: float) -> ReturnType:
        """Follow `references`: write `commands` and `exported_states`; see `Controller.update`."""

    def on_set_chained_mode(self, is_chained: bool) -> None:
        """Take note that `is_chained` has changed: references come from elsewhere from now on."""

    def update(self, time_s: float, period_s: float) -> ReturnType:
        """Compute one cycle."""
        if not self.is_chained:
            outcome = self.update_references(time_s, period_s)
            if outcome is not ReturnType.OK:
                return outcome
        return self.update_commands(time_s, period_s)

    def export(self) -> None:
        """Make the exported arrays; called by the manager after `on_configure`."""
        self.references = np.full(len(self.reference_names()), np.nan)
        self.exported_states = np.full(len(self.exported_state_names()), np.nan)
