"""The interfaces that chainable controllers lend to other controllers."""

from collections import Counter
from collections.abc import Mapping
from typing import Any, Protocol

import numpy as np
from numpy.typing import NDArray

from arm_control.chainable_controller import ChainableController
from arm_control.controller import Controller
from arm_control.errors import ControllerManagerError

Place = tuple[NDArray[np.float64], int]
"""An array, and where in it an interface stands."""


class Exporter(Protocol):
    """A loaded controller, as far as its exports are concerned."""

    @property
    def controller(self) -> Controller[Any]:
        """The controller itself."""
        ...

    @property
    def is_active(self) -> bool:
        """Whether it is being updated."""
        ...


class ExportedInterfaces:
    """Who exports what, by full name. Loop thread only.

    A reference is available while it is commanded, that is in chained mode; an exported state
    while its controller is active.
    """

    def __init__(self) -> None:
        self._references: dict[str, tuple[ChainableController[Any], Place]] = {}
        self._states: dict[str, tuple[Exporter, Place]] = {}

    def add(self, exporter: Exporter) -> None:
        """Take in what a controller exports; nothing where it is not chainable.

        Raises:
            ControllerManagerError: it is chainable and exports nothing, or a name twice.
        """
        controller = exporter.controller
        if not isinstance(controller, ChainableController):
            return
        references, states = controller.reference_names(), controller.exported_state_names()
        if not references and not states:
            raise ControllerManagerError("it is chainable, but exports no reference and no state")
        for kind, names in (("reference", references), ("state", states)):
            repeated = sorted(name for name, count in Counter(names).items() if count > 1)
            if repeated:
                raise ControllerManagerError(
                    f"it exports {kind} interface {', '.join(repeated)} more than once"
                )
        controller.export()
        readable = controller.exported_states.view()
        readable.setflags(write=False)
        for i, name in enumerate(references):
            full_name = f"{controller.name}/{name}"
            self._references[full_name] = (controller, (controller.references, i))
        for i, name in enumerate(states):
            self._states[f"{controller.name}/{name}"] = (exporter, (readable, i))

    def remove(self, controller: str) -> None:
        """Forget what a controller exports."""
        self._references = {
            name: entry for name, entry in self._references.items() if entry[0].name != controller
        }
        self._states = {
            name: entry
            for name, entry in self._states.items()
            if entry[0].controller.name != controller
        }

    def references(self) -> tuple[str, ...]:
        """Full names of all references."""
        return tuple(self._references)

    def states(self) -> tuple[str, ...]:
        """Full names of all exported states."""
        return tuple(self._states)

    def reference_owner(self, name: str) -> str | None:
        """Name of the controller that exports a reference, None where none does."""
        entry = self._references.get(name)
        return entry[0].name if entry else None

    def state_owner(self, name: str) -> str | None:
        """Name of the controller that exports a state, None where none does."""
        entry = self._states.get(name)
        return entry[0].controller.name if entry else None

    def is_reference_available(self, name: str) -> bool:
        """Whether a reference exists and its controller is in chained mode."""
        entry = self._references.get(name)
        return entry is not None and entry[0].is_chained

    def is_state_available(self, name: str) -> bool:
        """Whether an exported state exists and its controller is active."""
        entry = self._states.get(name)
        return entry is not None and entry[0].is_active

    def reference_place(self, name: str) -> Place:
        """Return where a reference's value stands.

        Raises:
            ControllerManagerError: no controller exports it, or none does any more.
        """
        return _place(self._references, name)

    def state_place(self, name: str) -> Place:
        """Return where an exported state's value stands; read-only.

        Raises:
            ControllerManagerError: no controller exports it, or none does any more.
        """
        return _place(self._states, name)


def _place(entries: Mapping[str, tuple[object, Place]], name: str) -> Place:
    entry = entries.get(name)
    if entry is None:
        raise ControllerManagerError(f"no controller exports '{name}'")
    return entry[1]
