"""Is everything installed that the arm suite is made of?"""

import re
import sys
from collections.abc import Sequence
from dataclasses import dataclass, field
from importlib.metadata import Distribution

from arm_cli.doctor.finding import Finding

NAME = "wheels"
SUITE = "arm-suite"
INSTALL = "pip install . from the arm suite's folder"
REQUIREMENT = re.compile(r"(?P<name>[\w.-]+)(\[[^]]*\])?\s*(==\s*(?P<version>[\w.]+))?")


@dataclass(frozen=True, slots=True)
class Wheels:
    """Compares what is installed with what the suite's own metadata ask for.

    Attributes:
        path: folders to look for distributions in.
    """

    path: Sequence[str] = field(default_factory=lambda: list(sys.path))

    def examine(self) -> Finding:
        """Look for every distribution; where one version is asked for, for that."""
        suite = self._find(SUITE)
        if suite is None:
            return Finding.warning(
                NAME, f"{SUITE} is not installed by pip, it runs from a folder", INSTALL
            )
        wanted = [r for r in suite.requires or [] if "extra ==" not in r]
        faults = [fault for requirement in wanted if (fault := self._fault(requirement))]
        if faults:
            return Finding.error(NAME, "; ".join(faults), INSTALL)
        return Finding.ok(NAME, f"{SUITE} {suite.version} and its {len(wanted)} requirements")

    def _fault(self, requirement: str) -> str | None:
        match = REQUIREMENT.match(requirement)
        if match is None:
            return None
        found, version = self._find(match["name"]), match["version"]
        if found is None:
            return f"{match['name']} is not installed"
        if version and found.version != version:
            return f"{match['name']} is {found.version} instead of {version}"
        return None

    def _find(self, name: str) -> Distribution | None:
        return next(iter(Distribution.discover(name=name, path=list(self.path))), None)
