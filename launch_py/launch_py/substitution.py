"""Values of a launch file that are known only when it is expanded."""

from __future__ import annotations

from abc import ABC, abstractmethod
from collections.abc import Iterable, Mapping, Sequence
from os import PathLike
from typing import TYPE_CHECKING, cast

from launch_py.errors import LaunchFileError

if TYPE_CHECKING:
    from launch_py.launch_context import LaunchContext


class Substitution(ABC):
    """A text that depends on the launch context."""

    is_costly = False
    """Whether performing it takes time or does something, so that a mere survey should not."""

    @abstractmethod
    def perform(self, context: LaunchContext) -> str:
        """Return the text.

        Raises:
            SubstitutionError: it has no value in this context.
        """

    def describe(self) -> str:
        """Return how it is written in a launch file, for messages."""
        return f"{type(self).__name__}(...)"


Text = str | PathLike[str] | Substitution | Iterable["str | PathLike[str] | Substitution"]
"""What every text of a launch file may be; the parts of an iterable are joined."""

Pairs = Mapping[str, Text] | Iterable[tuple[Text, Text]]
"""A dict, or what its `items()` gives."""


def perform_text(context: LaunchContext, value: Text) -> str:
    """Return the text that `value` stands for in this context.

    Raises:
        LaunchFileError: something other than text, path or substitution is in it.
        SubstitutionError: a substitution has no value.
    """
    if isinstance(value, str):
        return value
    if isinstance(value, Substitution):
        return value.perform(context)
    if isinstance(value, PathLike):
        return str(value.__fspath__())
    if isinstance(value, Iterable) and not isinstance(value, bytes):
        return "".join(perform_text(context, part) for part in value)
    raise LaunchFileError(
        f"a text or a substitution is needed, not {value!r} of type {type(value).__name__}"
    )


def describe_text(value: Text) -> str:
    """Return how `value` is written in a launch file, without performing it."""
    if isinstance(value, str):
        return value
    if isinstance(value, Substitution):
        return value.describe()
    if isinstance(value, PathLike):
        return str(value.__fspath__())
    if isinstance(value, Iterable) and not isinstance(value, bytes):
        return "".join(describe_text(part) for part in value)
    return repr(value)  # A mistake, of which a message is about to be made.


def is_costly(value: Text) -> bool:
    """Return whether a substitution in `value` is costly to perform."""
    if isinstance(value, Substitution):
        return value.is_costly
    if isinstance(value, str | PathLike):
        return False
    return any(is_costly(part) for part in value)


def keep_pairs(pairs: Pairs | None) -> tuple[tuple[Text, Text], ...]:
    """Return the pairs as a value that can be looked at twice, unlike what `zip` gives."""
    items = pairs.items() if isinstance(pairs, Mapping) else pairs or ()
    return tuple(cast("Iterable[tuple[Text, Text]]", items))


def perform_pairs(context: LaunchContext, pairs: Pairs, of: str) -> tuple[tuple[str, str], ...]:
    """Return the pairs with both sides performed; see `perform_text`.

    Args:
        context: the scope.
        pairs: the pairs.
        of: what they are given for, for the error.

    Raises:
        LaunchFileError: what is given is no pair, or a side of it is no text.
        SubstitutionError: a substitution has no value.
    """
    performed: list[tuple[str, str]] = []
    for pair in keep_pairs(pairs):
        if not isinstance(pair, Sequence) or isinstance(pair, str) or len(pair) != 2:
            raise LaunchFileError(f"{of} takes pairs of two texts, not {pair!r}")
        performed.append((perform_text(context, pair[0]), perform_text(context, pair[1])))
    return tuple(performed)
