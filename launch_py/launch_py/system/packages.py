"""Finds installed packages, their share folders and their executables.

It reads the files directly, because importlib.metadata and ament_index_python take ten times as
long for the same answers.
"""

from __future__ import annotations

import os
import re
import sys
from collections.abc import Iterable, Iterator, Mapping, Sequence
from contextlib import suppress
from dataclasses import dataclass
from functools import cache
from pathlib import Path

from launch_py.errors import NotFoundError, UnavailableError
from launch_py.near_names import (
    MAX_LISTED,
    describe_irregular_file,
    describe_known,
    did_you_mean,
    near_names,
)
from launch_py.system.programs import NOTHING, SAME, StandIn, stand_ins

MARKERS = "share/ament_index/resource_index/packages"
STAND_IN_MARK = "stand-in of arm-suite\n"
"""What the marker of a package holds that stands in the index for ROS 2's own tools only."""
PROGRAMS = "launch_py.programs"
"""Group of entry points: the name of a program, and the function that replaces it."""
STAND_INS = "launch_py.packages"
"""Group of entry points: the name of a ROS package, and the package that replaces it."""
NODES = "launch_py.nodes"
"""Group of entry points: the name of a console script, and the name of the node that it creates."""
PRELOADS = "launch_py.preloads"
"""Group of entry points: functions that Python executables call before their own imports."""

SHARE = re.compile(r"\$\(find-pkg-share (\w+)\)")
LAUNCH_ENDINGS = (".py", ".launch", "launch.xml", "launch.yaml", "launch.yml")
"""What the names of launch files end with."""
LAUNCH_ENDING = re.compile(r"\.launch(\.\w+)?$")


def launch_files(folder: Path | str) -> list[str]:
    """Return the names of a folder's launch files, sorted; none if the folder does not exist."""
    try:
        return sorted(name for name in os.listdir(folder) if name.endswith(LAUNCH_ENDINGS))
    except OSError:
        return []


def describe_missing_launch_file(path: Path | str, packages: Packages) -> str:
    """Return the error about a path that is not a launch file.

    It suggests similar launch files: those beside it, then, if the path is only a name, those of
    the packages. Every Python file may be a launch file; only those that are named like one count.

    Raises:
        ValueError: no file can have this name.
    """
    if os.path.exists(path):
        return describe_irregular_file("launch file", path)
    folder, name = os.path.split(path)
    beside = [each for each in launch_files(folder or os.curdir) if "launch" in each]
    near = _near_launch_files(name, {each: [each] for each in beside})
    if not near and not folder:
        near = _near_launch_files(name, packages.launch_commands())
    if near:
        return f"no launch file {path}; {did_you_mean(near)}"
    return f"no launch file {path}; {_describe_launch_files(folder, beside)}"


def _describe_launch_files(folder: str, names: Sequence[str]) -> str:
    if folder and not os.path.isdir(folder):
        return f"there is no folder {folder}"
    held = f"{os.path.realpath(folder)} holds {', '.join(names[:MAX_LISTED]) or 'none'}"
    if len(names) > MAX_LISTED:
        held += f" and {len(names) - MAX_LISTED} more"
    return held if folder or names else f"{held}, and no package has one of a similar name"


def _near_launch_files(name: str, known: Mapping[str, Sequence[str]]) -> list[str]:
    """Return what is known under similar names; the common end of all names does not count."""
    if name in known:
        return list(known[name])
    stems: dict[str, list[str]] = {}
    for each, values in known.items():
        stems.setdefault(LAUNCH_ENDING.sub("", each), []).extend(values)
    near = near_names(LAUNCH_ENDING.sub("", name), stems)
    return [value for stem in near for value in stems[stem]][:3]


def ament_prefixes(environ: Mapping[str, str]) -> list[str]:
    """Return the prefixes to search for packages: those of AMENT_PREFIX_PATH, then this Python's.

    This Python's prefix is added because the ROS wheels do not set AMENT_PREFIX_PATH, so packages
    installed by pip would not be found.
    """
    prefixes = [p for p in environ.get("AMENT_PREFIX_PATH", "").split(os.pathsep) if p]
    return prefixes if sys.prefix in prefixes else [*prefixes, sys.prefix]


@dataclass(frozen=True, slots=True)
class ConsoleScript:
    """A script of a Python distribution that calls `function` of `module`."""

    name: str
    module: str
    function: str

    @property
    def package(self) -> str:
        """The package it belongs to: the top-level package of its module."""
        return self.module.partition(".")[0]

    def command(self, preloads: Iterable[str] = ()) -> tuple[str, ...]:
        """Return the command line that runs it with this Python.

        Args:
            preloads: functions to call first, as "module:function".

        It does not use `-m`, which imports runpy (a few milliseconds) and does nothing if the
        module has no `__main__` part. `-P` keeps the current folder off sys.path. SIGINT during the
        imports ends the process silently, because there is nothing to clean up yet.
        """
        top = self.function.partition(".")[0]
        called = (preload.partition(":")[::2] for preload in preloads)
        first = "".join(f"from {module} import {name}; {name}(); " for module, name in called)
        code = (
            f"import signal, sys; sys.argv[0] = {self.name!r}; "
            "interrupted = signal.signal(signal.SIGINT, signal.SIG_DFL); "
            f"{first}from {self.module} import {top}; "
            f"signal.signal(signal.SIGINT, interrupted); sys.exit({self.function}())"
        )
        return (sys.executable, "-P", "-c", code)


class Packages:
    """The installed packages, from the prefixes of AMENT_PREFIX_PATH and this Python's path.

    This Python's prefix always comes last, so that packages in a user's workspace take precedence
    over those of this suite.
    """

    def __init__(
        self, environ: Mapping[str, str], python_path: Sequence[str] | None = None
    ) -> None:
        others = (prefix for prefix in ament_prefixes(environ) if prefix != sys.prefix)
        self._prefixes = [*others, sys.prefix]
        self._python_path = sys.path if python_path is None else python_path

    def share_folder(self, package: str) -> Path:
        """Return share/<package> of the first prefix that has the package.

        Raises:
            NotFoundError: no prefix has the package; the message suggests similar names.
        """
        for prefix in self._prefixes:
            if _has_package(prefix, package):
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
        # ROS 1's names of launch files lack the .py.
        for spelling in (name, f"{name}.py"):
            direct = share / "launch" / spelling
            if os.path.isfile(direct):
                return direct
        found = sorted(
            Path(folder, file)
            for folder, _, files in os.walk(share, followlinks=True)
            for file in files
            if file.endswith(LAUNCH_ENDINGS) and (file == name or "launch" in file)
        )
        for path in found:
            if path.name == name:
                return path
        known = describe_known(name, {path.name for path in found}, "it has")
        raise NotFoundError(f"package {package!r} has no launch file {name!r}; {known}")

    def launch_commands(self) -> dict[str, list[str]]:
        """Return "PACKAGE FILE" of all launch files, by the files' names."""
        commands: dict[str, list[str]] = {}
        for package in self.names():
            for name in launch_files(self.share_folder(package) / "launch"):
                commands.setdefault(name, []).append(f"{package} {name}")
        return commands

    def executable(self, package: str, name: str) -> tuple[str, ...]:
        """Return the command line of a package's executable.

        A script of a Python distribution comes first, then a file in <prefix>/lib/<package>. If
        there is neither, another executable may replace it (see `stand_in_of`), or a distribution
        may declare a replacement for the package, so that `package="controller_manager"` in a ROS
        launch file works.

        Raises:
            NotFoundError: there is no such package or executable; the message suggests similar
                names.
            UnavailableError: it is known, but nothing replaces it; the message says what to do.
        """
        found = self.stand_in_of(package, name)
        if found is None:
            return self._own_executable(package, name)
        if found.kind == NOTHING:
            raise UnavailableError(f"{name} of {package} is not available: {found.words[0]}")
        owner, program, *words = found.words
        filled = (SHARE.sub(lambda m: str(self.share_folder(m[1])), word) for word in words)
        return (*self._own_executable(owner, program), *filled)

    def stand_in_of(self, package: str, name: str) -> StandIn | None:
        """Return the replacement of an executable, or None if it is installed or has none."""
        for found in stand_ins(self._prefixes):
            if found.replaces(package, name):
                with suppress(NotFoundError):
                    self._own_executable(package, name)
                    return None
                return found
        return None

    def _own_executable(self, package: str, name: str) -> tuple[str, ...]:
        scripts = list(self._console_scripts())
        own = [script for script in scripts if script.package == package]
        for script in own:
            if script.name == name:
                return script.command(target for _, target in self._entry_points(PRELOADS))
        folders = [
            os.path.join(prefix, "lib", package)
            for prefix in self._prefixes
            if not _is_stand_in(prefix, package)
        ]
        files: set[str] = set()
        for folder in folders:
            path = os.path.join(folder, name)
            if os.path.isfile(path) and os.access(path, os.X_OK):
                return (path,)
            if os.path.isdir(folder):
                files.update(f for f in os.listdir(folder) if os.access(f"{folder}/{f}", os.X_OK))
        indexed = self._indexed_packages()
        if not own and not files and package not in indexed:
            for replaced, stand_in in self._entry_points(STAND_INS):
                if replaced == package and stand_in != package:
                    return self._own_executable(stand_in, name)
            owners = sorted({script.package for script in scripts if script.name == name})
            if owners:
                raise NotFoundError(
                    f"no package {package!r}; executable {name!r} is in package {owners[0]!r}"
                )
            raise self._no_package(package, indexed | {script.package for script in scripts})
        known = describe_known(name, files | {script.name for script in own}, "it has")
        raise NotFoundError(f"package {package!r} has no executable {name!r}; {known}")

    def executable_file(self, package: str, name: str) -> str | None:
        """Return the path of an executable in <prefix>/lib/<package>, None if there is none."""
        for prefix in self._prefixes:
            path = os.path.join(prefix, "lib", package, name)
            if os.path.isfile(path) and os.access(path, os.X_OK):
                return path
        return None

    def node_names(self, executable: str) -> list[str]:
        """Return the default names of the nodes that an executable creates.

        They are known only if a distribution declares them in its entry points.
        """
        return [node for script, node in self._entry_points(NODES) if script == executable]

    def stand_in(self, program: str) -> tuple[str, ...] | None:
        """Return the command line that replaces a program, by name or path; None if none does."""
        name = os.path.basename(program)
        for known, target in self._entry_points(PROGRAMS):
            if known == name:
                module, _, function = target.partition(":")
                return ConsoleScript(name, module.strip(), function.strip()).command()
        return None

    def names(self) -> list[str]:
        """Return the names of all packages, sorted."""
        return sorted(self._indexed_packages())

    def executables(self) -> list[tuple[str, str]]:
        """Return the package and the name of every executable, sorted."""
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
        found.update(
            (s.package, s.name)
            for s in stand_ins(self._prefixes)
            if s.kind == SAME and "::" not in s.name
        )
        return sorted(found)

    def _indexed_packages(self) -> set[str]:
        names: set[str] = set()
        for prefix in self._prefixes:
            folder = os.path.join(prefix, MARKERS)
            if os.path.isdir(folder):
                names.update(n for n in os.listdir(folder) if not _is_stand_in(prefix, n))
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
                changed_ns = os.stat(folder or os.curdir).st_mtime_ns
            except OSError:
                continue
            for section, name, target in _entry_points_in(os.path.abspath(folder), changed_ns):
                if section == group:
                    yield name, target


@cache
def _entry_points_in(folder: str, _changed_ns: int) -> tuple[tuple[str, str, str], ...]:
    """Return group, name and target of all entry points in a folder of Python's path.

    A launch asks some dozen times, and there may be hundreds of files. Installing and removing a
    distribution changes the folder, and so its time.
    """
    try:
        names = os.listdir(folder)
    except OSError:
        return ()
    files = (name for name in names if name.endswith((".dist-info", ".egg-info")))
    return tuple(
        found
        for name in files
        for found in _read_entry_points(os.path.join(folder, name, "entry_points.txt"))
    )


def _has_package(prefix: str, package: str) -> bool:
    marker = os.path.join(prefix, MARKERS, package)
    return os.path.isfile(marker) and not _is_stand_in(prefix, package)


def _is_stand_in(prefix: str, package: str) -> bool:
    """Return whether a prefix has the package for ROS 2's own tools only."""
    try:
        with open(os.path.join(prefix, MARKERS, package), encoding="utf-8") as file:
            return file.read(len(STAND_IN_MARK) + 1) == STAND_IN_MARK
    except (OSError, UnicodeError):
        return False


def _read_entry_points(path: str) -> Iterator[tuple[str, str, str]]:
    """Yield group, name and target of each entry point in a file."""
    try:
        with open(path, encoding="utf-8") as file:
            lines = file.read().splitlines()
    except OSError:
        return
    section = ""
    for line in lines:
        text = line.strip()
        if text.startswith("["):
            section = text.strip("[]")
        elif "=" in text and not text.startswith(("#", ";")):
            name, _, target = text.partition("=")
            yield section, name.strip(), target.strip()
