"""Is this a Python that the ROS wheels exist for?"""

import platform
import sys
from dataclasses import dataclass

from arm_cli.doctor.finding import Finding

NAME = "python"
OLDEST, NEWEST = (3, 11), (3, 13)
SYSTEM, MACHINE = "Linux", "x86_64"


@dataclass(frozen=True, slots=True)
class PythonVersion:
    """Compares the interpreter and the machine with those of the wheels."""

    version: tuple[int, int] = sys.version_info[:2]
    system: str = platform.system()
    machine: str = platform.machine()

    def examine(self) -> Finding:
        """Look at the version, the operating system and the processor."""
        here = f"Python {self.version[0]}.{self.version[1]} at {sys.executable}"
        if (self.system, self.machine) != (SYSTEM, MACHINE):
            return Finding.error(
                NAME,
                f"{here} runs on {self.system} {self.machine}; the ROS wheels exist for "
                f"{SYSTEM} {MACHINE} only",
                "use such a machine, a virtual one or a container",
            )
        if not OLDEST <= self.version <= NEWEST:
            return Finding.error(
                NAME,
                f"{here} has no ROS wheels; there are some for Python 3.11 to 3.13",
                "python3.12 -m venv .venv && source .venv/bin/activate, and install again",
            )
        return Finding.ok(NAME, here)
