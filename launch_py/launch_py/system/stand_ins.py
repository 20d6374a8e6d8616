"""Executables that replace those of packages that are not installed.

A package lists them in share/ament_index/resource_index/executable_stand_ins/<package>. The file of
arm_cli explains the format.
"""

from __future__ import annotations

import os
import shlex
from collections.abc import Iterator, Sequence
from dataclasses import dataclass
from fnmatch import fnmatchcase
from pathlib import Path

FOLDER = "share/ament_index/resource_index/executable_stand_ins"
SAME, OTHER, NOTHING = "=", "~", "!"


@dataclass(frozen=True, slots=True)
class StandIn:
    """The replacement of an executable.

    Attributes:
        package: the package of the missing executable, with wildcards.
        name: the name of the missing executable or composable node, with wildcards.
        kind: SAME for the same program, OTHER for another one, NOTHING if nothing replaces it.
        words: package, executable and arguments of the replacement; for NOTHING, a sentence.
    """

    package: str
    name: str
    kind: str
    words: tuple[str, ...]

    def replaces(self, package: str, name: str) -> bool:
        """Return whether this is the replacement of an executable."""
        return fnmatchcase(package, self.package) and fnmatchcase(name, self.name)

    @property
    def takes_ros_arguments(self) -> bool:
        """Whether the replacement is a node, not a command line tool."""
        return self.words[1] != "arm"

    @property
    def remark(self) -> str:
        """A message about the replacement, "" if it is the same program."""
        if self.kind != OTHER:
            return ""
        program = " ".join(word for word in self.words[1:] if not word.startswith("-"))
        if self.takes_ros_arguments:
            program = f"{self.words[1]} of {self.words[0]}"
        return f"{self.package} is not installed: {program} runs in place of {self.name}"


def stand_ins(prefixes: Sequence[str]) -> Iterator[StandIn]:
    """Yield the replacements that the packages in these prefixes list."""
    for prefix in prefixes:
        folder = os.path.join(prefix, FOLDER)
        if not os.path.isdir(folder):
            continue
        for file in sorted(os.listdir(folder)):
            for line in Path(folder, file).read_text(encoding="utf-8").splitlines():
                words = line.split(maxsplit=3)
                if len(words) == 4 and words[2] in (SAME, OTHER, NOTHING):
                    package, name, kind, rest = words
                    replacement = (rest,) if kind == NOTHING else tuple(shlex.split(rest))
                    yield StandIn(package, name, kind, replacement)
