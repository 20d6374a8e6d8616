"""The interfaces that chainable controllers export to other controllers."""

from collections import Counter
from collections.abc import Mapping
from typing import Any, Protocol

import numpy as np
from numpy.typing import NDArray

from arm_control.controllers.controller import ChainableController, Controller
from arm_control.errors import ControllerManagerError

Place = tuple[NDArray[np.float64], int]
"""An array, and the index of an interface in it."""


class _Exporter(Protocol):
    """A loaded controller whose interfaces may be exported."""

    @property
    def controller(self) -> Controller[Any]:
        """The controller itself."""
        ...

    @property
    def is_active(self) -> bool:
        """Whether it is being updated."""
        ...


class ExportedInterfaces:
    """The exported interfaces and their controllers, by full name. Loop thread only.

    A reference is available while its controller is in chained mode; an exported state is available
    while its controller is active.
    """

    def __init__(self) -> None:
        self._references: dict[str, tuple[ChainableController[Any], Place]] = {}
        self._states: dict[str, tuple[_Exporter, Place]] = {}

    def add(self, exporter: _Exporter) -> None:
        """Add the exports of a controller, if it is chainable.

        Raises:
            ControllerManagerError: it is chainable, but exports nothing or a name twice.
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
        """Remove the exports of a controller."""
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
        """Name of the controller that exports a reference, or None."""
        entry = self._references.get(name)
        return entry[0].name if entry else None

    def state_owner(self, name: str) -> str | None:
        """Name of the controller that exports a state, or None."""
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
        """Return the place of a reference's value.

        Raises:
            ControllerManagerError: no controller exports it.
        """
        return _place(self._references, name)

    def state_place(self, name: str) -> Place:
        """Return the place of an exported state's value; read-only.

        Raises:
            ControllerManagerError: no controller exports it.
        """
        return _place(self._states, name)


def _place(entries: Mapping[str, tuple[object, Place]], name: str) -> Place:
    entry = entries.get(name)
    if entry is None:
        raise ControllerManagerError(f"no controller exports '{name}'")
    return entry[1]
