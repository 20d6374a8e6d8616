"""What making a model repaired or dropped, for the user to read."""

import logging
from dataclasses import dataclass
from enum import Enum


class Outcome(Enum):
    """What became of an element; the word is for the user."""

    NOTED = "note"
    """The model differs from the description, as it must."""
    DROPPED = "dropped"
    """The simulation does without it, and nobody should miss it."""
    REPAIRED = "repaired"
    """It could not be as described, and something else takes its place."""
    DOUBTFUL = "warning"
    """It is as described, or left out, and probably not what was meant."""
    FAILED = "error"
    """There is no model because of it."""

    @property
    def level(self) -> int:
        """The level to log it at."""
        return _LEVELS.get(self, logging.WARNING)


_LEVELS = {
    Outcome.NOTED: logging.INFO,
    Outcome.DROPPED: logging.INFO,
    Outcome.FAILED: logging.ERROR,
}


@dataclass(frozen=True, slots=True)
class Finding:
    """One remark about one element of the description.

    Attributes:
        outcome: what became of it.
        element: for example "link 'wrist'".
        message: what is wrong and what was done.
        line: of the element in the description, 0 if unknown.
    """

    outcome: Outcome
    element: str
    message: str
    line: int = 0

    def __str__(self) -> str:
        where = f"{self.element} (line {self.line})" if self.line else self.element
        return f"{where}: {self.message}"


class BuildReport:
    """The findings of one build, in the order of their making."""

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

    def add(self, *findings: Finding) -> None:
        """Add what was found elsewhere."""
        self._findings.extend(findings)

    def inform(self, element: str, message: str, line: int = 0) -> None:
        """Add a remark."""
        self.add(Finding(Outcome.NOTED, element, message, line))

    def drop(self, element: str, message: str, line: int = 0) -> None:
        """Add what the simulation does without."""
        self.add(Finding(Outcome.DROPPED, element, message, line))

    def repair(self, element: str, message: str, line: int = 0) -> None:
        """Add what was replaced."""
        self.add(Finding(Outcome.REPAIRED, element, message, line))

    def warn(self, element: str, message: str, line: int = 0) -> None:
        """Add what is probably not as it was meant."""
        self.add(Finding(Outcome.DOUBTFUL, element, message, line))

    def log(self, logger: logging.Logger) -> None:
        """Write every finding to a logger, each at its level."""
        for finding in self._findings:
            logger.log(finding.outcome.level, "%s", finding)
