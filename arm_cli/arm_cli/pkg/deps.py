"""`arm pkg deps`: the dependencies of the packages in a folder, and where each comes from."""

import argparse
import os
import subprocess
import sys
import xml.etree.ElementTree as ET
from collections.abc import Iterable, Sequence
from dataclasses import dataclass
from importlib.metadata import PackageNotFoundError, version
from pathlib import Path

from arm_cli.arguments import JSON, Argument, Flag, verb
from arm_cli.errors import CommandUsageError, NoSuchNameError
from arm_cli.output import print_json, say
from arm_node.ros_distribution import ros_distribution
from arm_node.user_file import read_text
from launch_py.system.packages import Packages

MANIFEST = "package.xml"
TABLE = "config/dependencies.txt"
KINDS = (
    "depend",
    "build_depend",
    "build_export_depend",
    "exec_depend",
    "run_depend",
    "test_depend",
)
NOT_SEARCHED = ("build", "install", "log", "node_modules")
IGNORING = ("COLCON_IGNORE", "AMENT_IGNORE")
SUITE = ("arm-suite", "arm-interfaces", "arm-moveit-interfaces")


@dataclass(frozen=True, slots=True)
class _Dependency:
    """A dependency of packages, by its name in package.xml files.

    `pip` is the distribution that contains it, "" if there is none.
    """

    name: str
    needed_by: tuple[str, ...]
    pip: str
    installed: bool

    @property
    def source(self) -> str:
        """Where it comes from, as text for the user."""
        if self.pip in SUITE:
            return "this suite"
        if self.pip:
            return f"pip: {self.pip}"
        return "ROS" if self.installed else f"only apt: {apt_name(self.name)}"


@verb(
    Argument("paths", nargs="+", metavar="PATH", help="folders that contain packages"),
    Flag("--install", help="install missing dependencies that pip has"),
    JSON,
)
def deps(options: argparse.Namespace) -> int:
    """Print the dependencies, and install missing ones if requested.

    Returns 1 if any is still missing.
    """
    needed = needs_of(options.paths)
    found = [describe(name, by) for name, by in sorted(needed.items())]
    found = [dependency for dependency in found if dependency is not None]
    if options.json:
        print_json(
            [
                {
                    "name": d.name,
                    "needed_by": list(d.needed_by),
                    "source": d.source,
                    "installed": d.installed,
                }
                for d in found
            ]
        )
    else:
        print_table(found)
    missing = [dependency for dependency in found if not dependency.installed]
    # The suite's own distributions are installed from its folder, not from an index.
    wanted = sorted({d.pip for d in missing if d.pip and d.pip not in SUITE})
    if options.install and wanted:
        sys.stdout.flush()
        command = [sys.executable, "-m", "pip", "install", *wanted]
        code = subprocess.run(command, check=False).returncode
        if code:
            return code
        missing = [dependency for dependency in missing if dependency.pip not in wanted]
    return 1 if missing else 0


def needs_of(paths: Iterable[str]) -> dict[str, tuple[str, ...]]:
    """Return the dependencies of the packages below these folders, and which need each.

    The packages themselves are not among them.

    Raises:
        NoSuchNameError: there is no such folder, or no package in it.
        CommandUsageError: a package.xml is malformed.
    """
    own: set[str] = set()
    needed: dict[str, set[str]] = {}
    for path in paths:
        files = manifests(path)
        if not files:
            raise NoSuchNameError(f"no {MANIFEST} in {path} or in a folder below it")
        for file in files:
            name, names = read_manifest(file)
            own.add(name)
            for dependency in names:
                needed.setdefault(dependency, set()).add(name)
    return {name: tuple(sorted(by)) for name, by in needed.items() if name not in own}


def manifests(path: str) -> list[Path]:
    """Return the package.xml files of a folder, as colcon finds them.

    Raises:
        NoSuchNameError: there is no such folder.
    """
    if not os.path.isdir(path):
        raise NoSuchNameError(f"no folder {path}")
    found: list[Path] = []
    for folder, folders, files in os.walk(path):
        if any(name in files for name in IGNORING):
            folders.clear()
        elif MANIFEST in files:
            found.append(Path(folder, MANIFEST))
            folders.clear()
        folders[:] = [f for f in folders if not f.startswith(".") and f not in NOT_SEARCHED]
    return sorted(found)


def read_manifest(path: Path) -> tuple[str, list[str]]:
    """Return a package's name and its dependencies.

    Raises:
        CommandUsageError: the file cannot be read, or is not XML.
    """
    try:
        root = ET.fromstring(read_text(path))
    except (OSError, ET.ParseError) as error:
        raise CommandUsageError(f"{path} cannot be read: {error}") from error
    names = [(element.text or "").strip() for kind in KINDS for element in root.iter(kind)]
    return (root.findtext("name") or path.parent.name).strip(), [name for name in names if name]


def describe(name: str, needed_by: tuple[str, ...]) -> _Dependency | None:
    """Return a dependency; None if nothing has to be installed for it here."""
    table = known_sources()
    if table.get(name) == "-":
        return None
    pip = table.get(name, "")
    packages = Packages(os.environ)
    there = name in packages.names() or (bool(pip) and is_installed(pip))
    return _Dependency(name, needed_by, pip, there or is_installed(name))


def known_sources() -> dict[str, str]:
    """Return the distribution of each name in the table, "-" for one that is not needed."""
    text = read_text(Packages(os.environ).share_folder("arm_cli") / TABLE)
    lines = (line.split() for line in text.splitlines() if line.strip()[:1] not in ("", "#"))
    return {words[0]: words[-1] for words in lines}


def is_installed(distribution: str) -> bool:
    """Return whether pip has installed a distribution here."""
    try:
        return bool(version(distribution))
    except PackageNotFoundError:
        return False


def apt_name(name: str) -> str:
    """Return the name of a dependency's apt package."""
    if name.startswith("python3-") or name.startswith("lib"):
        return name
    return f"ros-{ros_distribution()}-{name.replace('_', '-')}"


def print_table(found: Sequence[_Dependency]) -> None:
    """Print one line for each dependency."""
    if not found:
        say("these packages need nothing else")
        return
    name = max(len(d.name) for d in found)
    source = max(len(d.source) for d in found)
    for d in found:
        state = "installed" if d.installed else "missing"
        say(f"{d.name:<{name}}  {d.source:<{source}}  {state:<9}  for {', '.join(d.needed_by)}")
