"""The result of one of the doctor's checks."""

from dataclasses import dataclass
from enum import StrEnum


class Severity(StrEnum):
    """The severity of a finding: an ERROR keeps the arm from moving or from being seen."""

    OK = "ok"
    WARNING = "warning"
    ERROR = "error"


@dataclass(frozen=True, slots=True)
class Diagnosis:
    """The result of one check; the fix is empty if there is nothing to do."""

    check: str
    severity: Severity
    sentence: str
    fix: str = ""

    @classmethod
    def ok(cls, check: str, sentence: str, fix: str = "") -> "Diagnosis":
        """Return the finding that nothing is wrong."""
        return cls(check, Severity.OK, sentence, fix)

    @classmethod
    def warning(cls, check: str, sentence: str, fix: str) -> "Diagnosis":
        """Return a finding that may be intended, or that slows things down."""
        return cls(check, Severity.WARNING, sentence, fix)

    @classmethod
    def error(cls, check: str, sentence: str, fix: str) -> "Diagnosis":
        """Return a finding that must be fixed."""
        return cls(check, Severity.ERROR, sentence, fix)
