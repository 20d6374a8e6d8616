"""Which topics are recorded, or played."""

import re
from collections.abc import Sequence
from dataclasses import dataclass

from arm_cli.errors import BagError
from arm_cli.names import absolute_name, is_hidden


@dataclass(frozen=True, slots=True)
class TopicSelection:
    """Chooses topics by their names.

    Attributes:
        every: whether all are wanted, but those excluded and hidden ones.
        names: wanted ones.
        pattern: those in which it is found are wanted, too.
        excluded_names: not wanted, whatever is said above.
        excluded_pattern: those in which it is found are not wanted either.
        hidden: whether `every` and `pattern` mean hidden ones, too.
    """

    every: bool = False
    names: frozenset[str] = frozenset()
    pattern: re.Pattern[str] | None = None
    excluded_names: frozenset[str] = frozenset()
    excluded_pattern: re.Pattern[str] | None = None
    hidden: bool = False

    def wants(self, name: str) -> bool:
        """Return whether a topic is wanted."""
        if name in self.excluded_names:
            return False
        if self.excluded_pattern is not None and self.excluded_pattern.search(name):
            return False
        if name in self.names:
            return True
        if is_hidden(name) and not self.hidden:
            return False
        return self.every or (self.pattern is not None and bool(self.pattern.search(name)))

    @property
    def is_closed(self) -> bool:
        """Whether the names are all that can ever be wanted."""
        return not self.every and self.pattern is None


def absolute_names(names: Sequence[str] | None) -> frozenset[str]:
    """Return names as the graph has them."""
    return frozenset(absolute_name(name) for name in names or ())


def compile_pattern(text: str | None, option: str) -> re.Pattern[str] | None:
    """Return a compiled regular expression, None for none.

    Raises:
        BagError: it is none.
    """
    if not text:
        return None
    try:
        return re.compile(text)
    except re.error as error:
        raise BagError(f"{option} {text!r} is no regular expression: {error}") from error
