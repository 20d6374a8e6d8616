"""Save and restore an object's attributes."""

from collections.abc import Collection, Iterator, Mapping
from typing import Any, Protocol, runtime_checkable

import numpy as np

from arm_control.state.class_names import attributes_by_present_name

State = Any
"""A plain value; see `arm_control.state.encoding`."""


@runtime_checkable
class Stateful(Protocol):
    """An object whose state can be saved, and restored in place."""

    def save_state(self) -> State:
        """Return the state. It may share arrays with the object, so encode it at once."""
        ...

    def load_state(self, state: State, /) -> None:
        """Restore a state that this object, or one set up in the same way, has saved."""
        ...


def save_attributes(owner: object, left_out: Collection[str] = ()) -> dict[str, State]:
    """Return the attributes of an object by name, and the states of those that are `Stateful`."""
    return {
        name: value.save_state() if isinstance(value, Stateful) else value
        for name, value in _attributes_of(owner)
        if name not in left_out
    }


def load_attributes(owner: object, state: Mapping[str, State]) -> None:
    """Set the attributes of an object, those that an earlier build saved included.

    An array of the same shape is changed in place, because others may hold a view of it.
    """
    for name, value in attributes_by_present_name(type(owner), state).items():
        present = getattr(owner, name, None)
        if isinstance(present, Stateful):
            present.load_state(value)
        elif isinstance(present, np.ndarray) and _is_alike(present, value):
            present[...] = value
        else:
            setattr(owner, name, value)


def _attributes_of(owner: object) -> Iterator[tuple[str, Any]]:
    yield from getattr(owner, "__dict__", {}).items()
    for base in type(owner).__mro__:
        slots = base.__dict__.get("__slots__", ())
        for name in (slots,) if isinstance(slots, str) else slots:
            if hasattr(owner, name) and name not in ("__dict__", "__weakref__"):
                yield name, getattr(owner, name)


def _is_alike(present: np.ndarray, value: Any) -> bool:
    return (
        isinstance(value, np.ndarray)
        and present.flags.writeable
        and present.dtype == value.dtype
        and present.shape == value.shape
    )
