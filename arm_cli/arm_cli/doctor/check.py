"""What every check of the doctor is."""

from typing import Protocol

from arm_cli.doctor.finding import Finding


class Check(Protocol):
    """Looks at one thing that can keep the arm from moving, or from being seen."""

    def examine(self) -> Finding:
        """Look, and return what was found; whatever is wrong is a finding, never an exception."""
        ...
