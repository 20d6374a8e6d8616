"""Finds installed packages, their share folders and their executables.

Reads the files themselves: importlib.metadata and ament_index_python give the same answers in ten
times the time, and a launcher is waited for.
"""

from __future__ import annotations

import os
import sys
from collections.abc import Iterator, Mapping, Sequence
from dataclasses import dataclass
from pathlib import Path

from launch_py.errors import NotFoundError
from launch_py.near_names import describe_known

MARKERS = "share/ament_index/resource_index/packages"
STAND_INS = "launch_py.packages"
"""Group of entry points: the name of a ROS package, and the one that has its executables here."""


def ament_prefixes(environ: Mapping[str, str]) -> list[str]:
    """Return the prefixes to look for packages in: those of AMENT_PREFIX_PATH, then this Python's.

    The ROS wheels do not set AMENT_PREFIX_PATH; without it nothing that pip installed is found.
    """
    prefixes = [p for p in environ.get("AMENT_PREFIX_PATH", "").split(os.pathsep) if p]
    return prefixes if sys.prefix in prefixes else [*prefixes, sys.prefix]


@dataclass(frozen=True, slots=True)
class ConsoleScript:
    """A script of a Python distribution: it calls `function` of `module`."""

    name: str
    module: str
    function: str

    @property
    def package(self) -> str:
        """The package it belongs to: the top one of its module."""
        return self.module.partition(".")[0]

    def command(self) -> tuple[str, ...]:
        """Return the command line that runs it with this Python.

        Not by `-m`: that imports runpy (a few milliseconds), and does nothing at all where the
        module lacks a `__main__` part. `-P` keeps the current folder off sys.path. Interrupted
        while it still imports, it ends without a word: there is nothing to take down yet.
        """
        top = self.function.partition(".")[0]
        code = (
            f"import signal, sys; sys.argv[0] = {self.name!r}; "
            "interrupted = signal.signal(signal.SIGINT, signal.SIG_DFL); "
            f"from {self.module} import {top}; "
            f"signal.signal(signal.SIGINT, interrupted); sys.exit({self.function}())"
        )
        return (sys.executable, "-P", "-c", code)


class Packages:
    """What is installed: in the prefixes of AMENT_PREFIX_PATH and on this Python's path."""

    def __init__(
        self, environ: Mapping[str, str], python_path: Sequence[str] | None = None
    ) -> None:
        self._prefixes = ament_prefixes(environ)
        self._python_path = sys.path if python_path is None else python_path

    def share_folder(self, package: str) -> Path:
        """Return share/<package> of the first prefix that has the package.

        Raises:
            NotFoundError: no prefix has it; the message names near ones.
        """
        for prefix in self._prefixes:
            if os.path.isfile(os.path.join(prefix, MARKERS, package)):
                return Path(prefix, "share", package)
        raise self._no_package(package, self._indexed_packages())

    def prefix(self, package: str) -> Path:
        """Return the prefix that holds the package."""
        return self.share_folder(package).parent.parent

    def launch_file(self, package: str, name: str) -> Path:
        """Return a launch file of a package, by its file name.

        Raises:
            NotFoundError: there is no such package or file.
        """
        share = self.share_folder(package)
        direct = share / "launch" / name
        if direct.is_file():
            return direct
        found = sorted(
            Path(folder, file)
            for folder, _, files in os.walk(share, followlinks=True)
            for file in files
            if file.endswith(("launch.py", ".py")) and (file == name or "launch" in file)
        )
        for path in found:
            if path.name == name:
                return path
        known = describe_known(name, {path.name for path in found}, "it has")
        raise NotFoundError(f"package {package!r} has no launch file {name!r}; {known}")

    def executable(self, package: str, name: str) -> tuple[str, ...]:
        """Return the command line of a package's executable.

        A script of a Python distribution comes first, then a file in <prefix>/lib/<package>. Where
        there is no such package, a distribution may have named one that stands for it, so that
        `package="controller_manager"` of a ROS launch file works.

        Raises:
            NotFoundError: there is no such package or executable; the message names near ones.
        """
        scripts = list(self._console_scripts())
        own = [script for script in scripts if script.package == package]
        for script in own:
            if script.name == name:
                return script.command()
        folders = [os.path.join(prefix, "lib", package) for prefix in self._prefixes]
        files: set[str] = set()
        for folder in folders:
            path = os.path.join(folder, name)
            if os.path.isfile(path) and os.access(path, os.X_OK):
                return (path,)
            if os.path.isdir(folder):
                files.update(f for f in os.listdir(folder) if os.access(f"{folder}/{f}", os.X_OK))
        indexed = self._indexed_packages()
        if not own and not files and package not in indexed:
            for name_there, stand_in in self._entry_points(STAND_INS):
                if name_there == package and stand_in != package:
                    return self.executable(stand_in, name)
            homes = sorted({script.package for script in scripts if script.name == name})
            if homes:
                raise NotFoundError(
                    f"no package {package!r}; executable {name!r} is in package {homes[0]!r}"
                )
            raise self._no_package(package, indexed | {script.package for script in scripts})
        known = describe_known(name, files | {script.name for script in own}, "it has")
        raise NotFoundError(f"package {package!r} has no executable {name!r}; {known}")

    def names(self) -> list[str]:
        """Return the names of all packages, sorted."""
        return sorted(self._indexed_packages())

    def executables(self) -> list[tuple[str, str]]:
        """Return package and name of all executables that packages have, sorted."""
        indexed = self._indexed_packages()
        found = {(s.package, s.name) for s in self._console_scripts() if s.package in indexed}
        for prefix in self._prefixes:
            for package in indexed:
                folder = os.path.join(prefix, "lib", package)
                if os.path.isdir(folder):
                    found.update(
                        (package, name)
                        for name in os.listdir(folder)
                        if os.path.isfile(f"{folder}/{name}")
                        and os.access(f"{folder}/{name}", os.X_OK)
                    )
        return sorted(found)

    def _indexed_packages(self) -> set[str]:
        names: set[str] = set()
        for prefix in self._prefixes:
            folder = os.path.join(prefix, MARKERS)
            if os.path.isdir(folder):
                names.update(os.listdir(folder))
        return names

    def _no_package(self, package: str, known: set[str]) -> NotFoundError:
        searched = os.pathsep.join(self._prefixes)
        hint = describe_known(package, known, "there is")
        return NotFoundError(f"no package {package!r} in {searched}; {hint}")

    def _console_scripts(self) -> Iterator[ConsoleScript]:
        for name, target in self._entry_points("console_scripts"):
            module, _, function = target.partition("[")[0].strip().partition(":")
            yield ConsoleScript(name, module.strip(), function.strip())

    def _entry_points(self, group: str) -> Iterator[tuple[str, str]]:
        for folder in self._python_path:
            try:
                names = os.listdir(folder or os.curdir)
            except OSError:
                continue
            for name in names:
                if name.endswith((".dist-info", ".egg-info")):
                    path = os.path.join(folder, name, "entry_points.txt")
                    yield from _read_entry_points(path, group)


def _read_entry_points(path: str, group: str) -> Iterator[tuple[str, str]]:
    """Yield names and targets of one group."""
    try:
        with open(path, encoding="utf-8") as file:
            lines = file.read().splitlines()
    except OSError:
        return
    section = ""
    for line in lines:
        text = line.strip()
        if text.startswith("["):
            section = text
        elif section == f"[{group}]" and "=" in text and not text.startswith(("#", ";")):
            name, _, target = text.partition("=")
            yield name.strip(), target.strip()
