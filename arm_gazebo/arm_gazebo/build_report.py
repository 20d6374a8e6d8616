"""What making a model changed, repaired or dropped, for the user to read."""

import logging
from dataclasses import dataclass
from enum import Enum


class Severity(Enum):
    """How much a finding matters; the value is the level to log it at."""

    INFO = logging.INFO
    """The model differs from the description, as it must."""
    WARNING = logging.WARNING
    """Something was repaired or left out; the simulation may differ from what was meant."""


@dataclass(frozen=True, slots=True)
class Finding:
    """One remark about one element of the description.

    Attributes:
        severity: how much it matters.
        element: for example "link 'wrist'".
        message: what is wrong and what was done.
        line: of the element in the description, 0 if unknown.
    """

    severity: Severity
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
        return tuple(f for f in self._findings if f.severity is Severity.WARNING)

    def inform(self, element: str, message: str, line: int = 0) -> None:
        """Add a remark."""
        self._findings.append(Finding(Severity.INFO, element, message, line))

    def warn(self, element: str, message: str, line: int = 0) -> None:
        """Add a warning."""
        self._findings.append(Finding(Severity.WARNING, element, message, line))

    def log(self, logger: logging.Logger) -> None:
        """Write every finding to a logger, warnings as warnings."""
        for finding in self._findings:
            logger.log(finding.severity.value, "%s", finding)
