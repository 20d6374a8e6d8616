"""What a check found."""

from dataclasses import dataclass
from enum import StrEnum


class Severity(StrEnum):
    """How bad it is: an ERROR keeps the arm from moving or from being seen."""

    OK = "ok"
    WARNING = "warning"
    ERROR = "error"


@dataclass(frozen=True, slots=True)
class Finding:
    """The result of one check.

    Attributes:
        check: the check's name.
        severity: how bad it is.
        sentence: what was found, in plain words.
        fix: what to do about it; empty where there is nothing to do.
    """

    check: str
    severity: Severity
    sentence: str
    fix: str = ""

    @classmethod
    def ok(cls, check: str, sentence: str, fix: str = "") -> "Finding":
        """Return that all is well."""
        return cls(check, Severity.OK, sentence, fix)

    @classmethod
    def warning(cls, check: str, sentence: str, fix: str) -> "Finding":
        """Return what may be meant so, or slows things down."""
        return cls(check, Severity.WARNING, sentence, fix)

    @classmethod
    def error(cls, check: str, sentence: str, fix: str) -> "Finding":
        """Return what must be mended."""
        return cls(check, Severity.ERROR, sentence, fix)
