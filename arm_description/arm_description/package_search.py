"""Searches for packages: near the description's file first, in this suite last."""

import os
import re
import sys
from collections.abc import Iterator, Mapping, Sequence
from functools import cached_property
from pathlib import Path

from arm_node.frozen import frozen
from arm_node.user_file import read_text

MODEL_PATH_VARIABLES = ("GZ_SIM_RESOURCE_PATH", "GAZEBO_MODEL_PATH")
"""The variables in which Gazebo's users list their model folders."""
MANIFEST = "package.xml"
FOLDERS_UP = 3
"""Minimum: the description file's folder, its package, and the folder of its neighbours."""
MAX_DEPTH = 3
"""How deep below a given folder a package may be: SOURCE/REPOSITORY/PACKAGE."""
MAX_FOLDERS = 2000
"""How many folders are searched below one folder."""
NOT_SEARCHED = ("COLCON_IGNORE", "AMENT_IGNORE", "CATKIN_IGNORE")
OWN = "the file's own"
GIVEN = "from the package path"
BESIDE = "beside the file"
AMENT = "from AMENT_PREFIX_PATH"
GAZEBO = "from Gazebo's resource path"
SUITE = "installed with the suite"
_MANIFEST_NAME = re.compile(r"<name>\s*([\w.-]+)\s*</name>")


@frozen
class PackagePlace:
    """A folder that may be a package, existing or not.

    Attributes:
        folder: folder of the package's data.
        origin: why it is searched, for messages: one of the constants above.
    """

    folder: Path
    origin: str


class PackageSearch:
    """Yields the possible places of a package in order of precedence.

    1. the package that contains the description's file,
    2. the folders that the user names,
    3. the neighbours of the file and of its package,
    4. the prefixes in AMENT_PREFIX_PATH, except this Python's,
    5. the folders of GZ_SIM_RESOURCE_PATH and GAZEBO_MODEL_PATH,
    6. neighbouring folders that only have the package's name,
    7. the prefix of this Python, which contains the suite's packages.

    A folder is the package NAME if its package.xml says so, or if the folder has that name.

    Args:
        file: the description's file; None if unknown.
        package_path: the folders that the user names. Each is a package, contains packages, or is a
            workspace's `src` or `install`.
        environ: the environment variables.
    """

    def __init__(
        self, file: Path | None, package_path: Sequence[Path], environ: Mapping[str, str]
    ) -> None:
        self._files = _with_target(file)
        self._package_path = tuple(package_path)
        self._environ = environ
        # Each package.xml is read once, because a robot may have a hundred meshes in one package.
        self._below: dict[tuple[Path, int], tuple[tuple[str, Path], ...]] = {}
        self._names: dict[Path, str] = {}
        self._own_folders: dict[str, tuple[Path, ...]] = {}

    def places(self, name: str) -> Iterator[PackagePlace]:
        """Yield the folders that may be the package."""
        if name not in self._own_folders:
            self._own_folders[name] = self._own(name)
        for folder in self._own_folders[name]:
            yield PackagePlace(folder, OWN)
        for given in self._package_path:
            for folder in self._in(given, name, MAX_DEPTH):
                yield PackagePlace(folder, GIVEN)
        beside = [folder for around in self._around for folder in self._in(around, name, 1)]
        for folder in beside:
            if self.is_package(folder, name):
                yield PackagePlace(folder, BESIDE)
        for share in self._shares:
            if share != _OWN_SHARE:
                yield PackagePlace(share / name, AMENT)
        for models in model_folders(self._environ):
            for folder in self._in(models, name, 1):
                yield PackagePlace(folder, GAZEBO)
        for folder in beside:
            yield PackagePlace(folder, BESIDE)
        yield PackagePlace(_OWN_SHARE / name, SUITE)

    def folders(self) -> tuple[Path, ...]:
        """Return the folders in which relative paths are looked up.

        They are the file's folder, its package, the user's folders, and then the folders above the
        package.
        """
        beside = [file.parent for file in self._files]
        own = [package for file in self._files for package in _packages_around(file)[:1]]
        around = [folder for file in self._files for folder in _folders_around(file)]
        return tuple(dict.fromkeys([*beside, *own, *self._package_path, *around]))

    def is_package(self, folder: Path, name: str) -> bool:
        """Return whether a folder's package.xml has this name."""
        if folder not in self._names:
            self._names[folder] = package_name(folder)
        return bool(name) and self._names[folder] == name

    def _own(self, name: str) -> tuple[Path, ...]:
        found: dict[Path, None] = {}
        for file in self._files:
            found.update((p, None) for p in _packages_around(file) if self.is_package(p, name))
        for file in self._files:
            found.update((p, None) for p in file.parents[:FOLDERS_UP] if p.name == name)
        return tuple(found)

    @cached_property
    def _shares(self) -> list[Path]:
        return share_folders(self._environ)

    @cached_property
    def _around(self) -> tuple[Path, ...]:
        """The folders that contain the neighbours of the file.

        There are none for an installed file, whose neighbours are in AMENT_PREFIX_PATH.
        """
        if any(set(self._shares).intersection(file.parents) for file in self._files):
            return ()
        return tuple(folder for file in self._files for folder in _folders_around(file))

    def _in(self, folder: Path, name: str, depth: int) -> Iterator[Path]:
        if folder.name == name or self.is_package(folder, name):
            yield folder
        yield folder / name
        for installed in (folder / "share" / name, folder / name / "share" / name):
            if os.path.isdir(installed):
                yield installed
        for called, package in self._packages_below(folder, depth):
            if called == name and package != folder / name:
                yield package

    def _packages_below(self, folder: Path, depth: int) -> tuple[tuple[str, Path], ...]:
        """Return names and folders of the packages below a folder, read once."""
        key = (folder, depth)
        if key not in self._below:
            self._below[key] = tuple(_walk(folder, depth))
        return self._below[key]


def share_folders(environ: Mapping[str, str] = os.environ) -> list[Path]:
    """Return the folders that contain packages' data, this Python's last."""
    prefixes = [p for p in environ.get("AMENT_PREFIX_PATH", "").split(os.pathsep) if p]
    own = os.path.realpath(sys.prefix)
    shares = (Path(prefix) / "share" for prefix in prefixes if os.path.realpath(prefix) != own)
    return [*dict.fromkeys(shares), _OWN_SHARE]


def suite_package(name: str, environ: Mapping[str, str] = os.environ) -> Path | None:
    """Return the folder of a package of this suite, None if it is not installed.

    Unlike a search, it does not find a user's package of the same name.
    """
    *others, own = share_folders(environ)
    return next((share / name for share in (own, *others) if (share / name).is_dir()), None)


def model_folders(environ: Mapping[str, str]) -> list[Path]:
    """Return the folders in which Gazebo searches for models."""
    paths = (environ.get(variable, "") for variable in MODEL_PATH_VARIABLES)
    return [Path(folder) for path in paths for folder in path.split(os.pathsep) if folder]


def package_name(folder: Path) -> str:
    """Return the name in a folder's package.xml, "" if there is none."""
    try:
        found = _MANIFEST_NAME.search(read_text(folder / MANIFEST))
    except (OSError, ValueError):
        return ""
    return found.group(1) if found else ""


_OWN_SHARE = Path(sys.prefix) / "share"


def _with_target(file: Path | None) -> tuple[Path, ...]:
    """Return a file's path and, if it is a link, its target's path.

    `colcon build --symlink-install` links files one by one.
    """
    if file is None:
        return ()
    return tuple(dict.fromkeys([Path(os.path.abspath(file)), Path(os.path.realpath(file))]))


def _packages_around(file: Path) -> list[Path]:
    """Return the packages that contain a file, the innermost first."""
    return [folder for folder in file.parents if os.path.isfile(folder / MANIFEST)]


def _folders_around(file: Path) -> tuple[Path, ...]:
    """Return the folders above a file, up to the one that contains its package's neighbours.

    In a workspace's install folder, that is the one with a prefix for each package.
    """
    above = tuple(file.parents)
    package = next((i for i, folder in enumerate(above) if (folder / MANIFEST).is_file()), 0)
    is_installed = len(above) > package + 1 and above[package + 1].name == "share"
    return above[: max(FOLDERS_UP, package + (4 if is_installed else 2))]


def _walk(top: Path, depth: int) -> Iterator[tuple[str, Path]]:
    """Yield names and folders of the packages below a folder, level by level.

    It does not search inside packages.
    """
    level, seen = [top], 0
    for _ in range(depth):
        following: list[Path] = []
        for folder in (inner for outer in level for inner in _folders_in(outer)):
            seen += 1
            if seen > MAX_FOLDERS:
                return
            if name := package_name(folder):
                yield name, folder
            elif not any(os.path.exists(folder / mark) for mark in NOT_SEARCHED):
                following.append(folder)
        level = following


def _folders_in(folder: Path) -> list[Path]:
    try:
        with os.scandir(folder) as entries:
            names = [e.name for e in entries if e.is_dir() and not e.name.startswith(".")]
    except (OSError, ValueError):
        return []
    return [folder / name for name in sorted(names)]
