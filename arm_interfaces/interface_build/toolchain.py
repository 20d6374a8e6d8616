"""Finds and runs the C and C++ compilers."""

import os
import shlex
import shutil
import subprocess
import sysconfig
from collections.abc import Sequence
from dataclasses import dataclass
from pathlib import Path

from interface_build.errors import CompileError, MissingToolError
from interface_build.project import read_project

_INSTALL_HINT = "on Debian and Ubuntu: apt install gcc g++ python3-dev"
_FLAGS = ("-fPIC", "-w", "-DNDEBUG")
_SHOWN_LINES = 20


@dataclass(frozen=True, slots=True)
class Toolchain:
    """Commands that compile and link.

    Attributes:
        c: the C compiler with its first arguments.
        cpp: the C++ compiler with its first arguments; it also links.
    """

    c: tuple[str, ...]
    cpp: tuple[str, ...]

    def compile(
        self, source: Path, target: Path, includes: Sequence[Path], optimisation: str
    ) -> None:
        """Compile one C or C++ file.

        Raises:
            CompileError: with the first lines that the compiler wrote.
        """
        compiler = self.cpp if source.suffix == ".cpp" else self.c
        include_flags = [f"-I{folder}" for folder in includes]
        _run(
            [*compiler, *_FLAGS, optimisation, *include_flags, "-c", str(source)],
            target,
        )

    def link(self, objects: Sequence[Path], target: Path, flags: Sequence[str]) -> None:
        """Link a shared library without debug symbols.

        Raises:
            CompileError: with the first lines that the linker wrote.
        """
        _run([*self.cpp, "-shared", "-s", *map(str, objects), *flags], target)


def find_toolchain() -> Toolchain:
    """Find the compilers (``CC`` and ``CXX`` override gcc and g++) and ``Python.h``.

    Raises:
        MissingToolError: one is missing; the message says how to install it.
    """
    toolchain = Toolchain(
        c=tuple(shlex.split(os.environ.get("CC", "gcc"))),
        cpp=tuple(shlex.split(os.environ.get("CXX", "g++"))),
    )
    missing = [
        command[0] for command in (toolchain.c, toolchain.cpp) if not shutil.which(command[0])
    ]
    if not python_header().is_file():
        missing.append(f"Python.h (looked for {python_header()})")
    if missing:
        raise MissingToolError(
            f"{read_project().name} compiles ROS 2 messages and lacks {' and '.join(missing)}; "
            f"{_INSTALL_HINT}"
        )
    return toolchain


def python_header() -> Path:
    """Return the expected path of this interpreter's ``Python.h``."""
    return Path(sysconfig.get_path("include")) / "Python.h"


def _run(command: Sequence[str], target: Path) -> None:
    """Run a compiler that writes ``target``; raise an error with its output if it fails."""
    result = subprocess.run(
        [*command, "-o", str(target)], capture_output=True, text=True, errors="replace", check=False
    )
    if result.returncode:
        output = "\n".join(result.stderr.splitlines()[:_SHOWN_LINES])
        raise CompileError(f"{command[0]} could not build {target.name}:\n{output}")
