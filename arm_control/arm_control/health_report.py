"""One entry of a health report, as ROS diagnostics show it."""

from dataclasses import dataclass, field
from enum import IntEnum


class Level(IntEnum):
    """How bad it is; numbered as in diagnostic_msgs/msg/DiagnosticStatus."""

    OK = 0
    WARN = 1
    ERROR = 2


@dataclass(slots=True)
class HealthReport:
    """A task's state in one sentence, with figures; built up step by step.

    Attributes:
        task: what it is about.
        level: how bad the worst of it is.
        message: what there is to say at that level.
        values: figures and states by name.
    """

    task: str
    level: Level = Level.OK
    message: str = ""
    values: dict[str, str] = field(default_factory=dict)

    def merge(self, level: Level, message: str) -> None:
        """Add a finding: the worst level counts, and what is wrong displaces what is well."""
        if self.message and (level > Level.OK) == (self.level > Level.OK):
            self.message += f"; {message}"
        elif level > self.level or not self.message:
            self.message = message
        self.level = max(self.level, level)
