"""Selects the topics to record or to play."""

import re
from collections.abc import Sequence
from dataclasses import dataclass

from arm_cli.errors import BagError
from arm_cli.names import absolute_name, is_hidden


@dataclass(frozen=True, slots=True)
class TopicSelection:
    """Selects topics by their names.

    Attributes:
        every: whether to select all topics except excluded and hidden ones.
        names: names of topics to select.
        pattern: selects the topics that match it.
        excluded_names: names of topics to leave out, whatever the attributes above select.
        excluded_pattern: leaves out the topics that match it.
        hidden: whether `every` and `pattern` select hidden topics too.
    """

    every: bool = False
    names: frozenset[str] = frozenset()
    pattern: re.Pattern[str] | None = None
    excluded_names: frozenset[str] = frozenset()
    excluded_pattern: re.Pattern[str] | None = None
    hidden: bool = False

    def wants(self, name: str) -> bool:
        """Return whether a topic is selected."""
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
        """Whether only `names` can select topics."""
        return not self.every and self.pattern is None


def absolute_names(names: Sequence[str] | None) -> frozenset[str]:
    """Return names as the graph shows them."""
    return frozenset(absolute_name(name) for name in names or ())


def compile_pattern(text: str | None, option: str) -> re.Pattern[str] | None:
    """Return a compiled regular expression, None without a text.

    Raises:
        BagError: the text is not a regular expression.
    """
    if not text:
        return None
    try:
        return re.compile(text)
    except re.error as error:
        raise BagError(f"{option} {text!r} is not a regular expression: {error}") from error
