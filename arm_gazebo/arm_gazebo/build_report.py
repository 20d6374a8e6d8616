"""The report to the user: what the model builder repaired, dropped or left out."""

import logging
from collections.abc import Iterable, Iterator, Sequence
from dataclasses import replace
from enum import Enum

from arm_node.frozen import frozen

MAX_NAMED = 5
"""How many kinds of missing things one line names; the log names all of them."""

MAX_ALIKE = 3
"""How many findings with one message are shown one by one; of more, the first with their number."""


class BuildOutcome(Enum):
    """What happened to an element; the value is the word shown to the user."""

    NOTED = "note"
    """The model differs from the description by design."""
    DROPPED = "dropped"
    """The simulation ignores it, and users will not notice."""
    LEFT_OUT = "left out"
    """The simulation lacks something visible or touchable, and users will notice."""
    REPAIRED = "repaired"
    """The description was invalid, and the model uses something else instead."""
    DOUBTFUL = "warning"
    """The description is probably not what its author meant."""
    FAILED = "error"
    """The model could not be built because of it."""

    @property
    def level(self) -> int:
        """The logging level."""
        return _LEVELS.get(self, logging.WARNING)


_LEVELS = {
    BuildOutcome.NOTED: logging.INFO,
    BuildOutcome.DROPPED: logging.INFO,
    BuildOutcome.FAILED: logging.ERROR,
}


@frozen
class Finding:
    """One remark about one element of the description.

    Attributes:
        outcome: what happened to the element.
        element: for example "link 'wrist'".
        message: what is wrong and what was done.
        line: line of the element in the description, 0 if unknown.
        count: how many elements the finding covers.
    """

    outcome: BuildOutcome
    element: str
    message: str
    line: int = 0
    count: int = 1

    def __str__(self) -> str:
        where = f"{self.element} (line {self.line})" if self.line else self.element
        return f"{where}: {self.message}"


def as_one(findings: Sequence[Finding]) -> Finding:
    """Return the first of findings that are alike, with the number of the others in its name."""
    first, others = findings[0], len(findings) - 1
    if not others:
        return first
    count = sum(finding.count for finding in findings)
    return replace(first, element=f"{first.element} and {others} more", count=count)


def shown(findings: Iterable[Finding]) -> Iterator[Finding]:
    """Yield findings to show in their order, many alike as one: a hand may have 24 bad links."""
    groups: dict[tuple[BuildOutcome, str, str], list[Finding]] = {}
    for finding in findings:
        kind = finding.element.partition("'")[0]
        groups.setdefault((finding.outcome, kind, finding.message), []).append(finding)
    for group in groups.values():
        if len(group) <= MAX_ALIKE:
            yield from group
        else:
            yield as_one(group)


class BuildReport:
    """The findings of one build, in order."""

    def __init__(self) -> None:
        self._findings: list[Finding] = []

    @property
    def findings(self) -> tuple[Finding, ...]:
        """Everything found so far."""
        return tuple(self._findings)

    @property
    def warnings(self) -> tuple[Finding, ...]:
        """The findings that a user should look at."""
        return tuple(f for f in self._findings if f.outcome.level >= logging.WARNING)

    @property
    def left_out(self) -> str:
        """One line that counts and names what was left out; "" if nothing was."""
        missing = [f for f in self._findings if f.outcome is BuildOutcome.LEFT_OUT]
        if not missing:
            return ""
        count = sum(finding.count for finding in missing)
        named = [finding.element for finding in missing[:MAX_NAMED]]
        more = ["..."] if len(missing) > MAX_NAMED else []
        things = "1 thing is" if count == 1 else f"{count} things are"
        return f"{things} left out: {'; '.join([*named, *more])}"

    def add(self, *findings: Finding) -> None:
        """Add findings made elsewhere."""
        self._findings.extend(findings)

    def inform(self, element: str, message: str, line: int = 0) -> None:
        """Add a note."""
        self.add(Finding(BuildOutcome.NOTED, element, message, line))

    def drop(self, element: str, message: str, line: int = 0) -> None:
        """Add something that the simulation ignores."""
        self.add(Finding(BuildOutcome.DROPPED, element, message, line))

    def leave_out(self, element: str, message: str, line: int = 0) -> None:
        """Add something that the simulation lacks and users will notice."""
        self.add(Finding(BuildOutcome.LEFT_OUT, element, message, line))

    def repair(self, element: str, message: str, line: int = 0) -> None:
        """Add something that was replaced because it was invalid."""
        self.add(Finding(BuildOutcome.REPAIRED, element, message, line))

    def warn(self, element: str, message: str, line: int = 0) -> None:
        """Add something that is probably not what the author meant."""
        self.add(Finding(BuildOutcome.DOUBTFUL, element, message, line))

    def log(self, logger: logging.Logger) -> None:
        """Log the findings at their levels, many alike as one."""
        for finding in shown(self._findings):
            logger.log(finding.outcome.level, "%s", finding)
