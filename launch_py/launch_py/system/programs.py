"""Finds programs on PATH, as a shell does, and beside this Python; and what replaces others.

A package lists the replacements of executables that are not installed in
share/ament_index/resource_index/executable_stand_ins/<package>. The file of arm_cli explains the
format.
"""

from __future__ import annotations

import os
import shlex
import sys
from collections.abc import Iterator, Sequence
from dataclasses import dataclass
from fnmatch import fnmatchcase
from pathlib import Path

from launch_py.errors import NotFoundError
from launch_py.near_names import describe_known

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


INSTEAD = {"ros2": "arm"}
"""Programs that ROS launch files run, and the program with the same verbs if they are missing."""


def scripts_folder() -> str:
    """Return the folder of this Python's scripts.

    `arm` also works from a virtual environment that is not activated. The programs that pip
    installed beside it are then not on PATH.
    """
    return os.path.dirname(sys.executable)


def find_program(name: str, path: str) -> str:
    """Return the path of a program.

    Args:
        name: a name, or a path with a slash in it; see INSTEAD.
        path: the folders to search, in the format of the variable PATH.

    Raises:
        NotFoundError: there is no such program; the message suggests similar names.
    """
    if os.sep in name:
        if os.path.isfile(name) and os.access(name, os.X_OK):
            return name
        reason = "is not executable" if os.path.exists(name) else "does not exist"
        raise NotFoundError(f"program {name} {reason}")
    folders = [*filter(None, path.split(os.pathsep)), scripts_folder()]
    for wanted in filter(None, (name, INSTEAD.get(name))):
        for folder in folders:
            candidate = os.path.join(folder, wanted)
            if os.path.isfile(candidate) and os.access(candidate, os.X_OK):
                return candidate
    hint = _near_program(name, folders)
    raise NotFoundError(
        f"no program {name!r} on PATH or in {scripts_folder()}{hint and '; ' + hint}"
    )


def _near_program(name: str, folders: list[str]) -> str:
    """Return a suggestion of programs with similar names, "" if there are none."""
    names: set[str] = set()
    for folder in folders:
        if os.path.isdir(folder):
            names.update(os.listdir(folder))
    hint = describe_known(name, names)
    return hint if hint.startswith("did you mean") else ""
