"""The setuptools commands that build the interface packages."""

import sys
from pathlib import Path
from typing import TextIO

from setuptools.command.build import build
from setuptools.command.build_ext import build_ext
from setuptools.command.egg_info import egg_info

from interface_build.interface_package import InterfacePackage, find_packages
from interface_build.project import DEFINITIONS, read_project
from interface_build.toolchain import find_toolchain
from interface_build.work_folder import scratch_folder

_INDEX = "share/ament_index/resource_index"


class BuildProgress:
    """Writes one line per step to a stream; pip shows them with ``-v``."""

    def __init__(self, name: str, stream: TextIO) -> None:
        """Write to ``stream``, flushing each line so that it passes a pipe immediately.

        Args:
            name: the distribution's name, which begins each line.
            stream: where to write.
        """
        self._name = name
        self._stream = stream

    def say(self, sentence: str) -> None:
        """Write a line."""
        self._stream.write(f"{self._name}: {sentence}\n")
        self._stream.flush()

    def report(self, label: str, done: int, total: int) -> None:
        """Write the completed step and the percentage."""
        self.say(f"[{100 * done // total:3d} %] {label}")


class Build(build):
    """Builds outside the source tree."""

    def initialize_options(self) -> None:
        """Set the folder below which setuptools builds."""
        super().initialize_options()
        self.build_base = str(scratch_folder("build"))


class EggInfo(egg_info):
    """Keeps setuptools' metadata outside the source tree."""

    def initialize_options(self) -> None:
        """Set the folder for the metadata."""
        super().initialize_options()
        self.egg_base = str(scratch_folder("egg_info"))


class BuildInterfaces(build_ext):
    """Generates, compiles and links all interface packages.

    The extensions in setup.py have no sources: they only tell setuptools that the wheel is for one
    Python version and platform.
    """

    def run(self) -> None:
        """Build into ``build_lib`` and register the files for ``share``.

        Raises:
            BuildError: a tool is missing or failed.
        """
        packages = find_packages(DEFINITIONS)
        _build_packages(packages, Path(self.build_lib))
        markers = scratch_folder("markers")
        self.distribution.data_files = [
            entry for package in packages for entry in _shared_files(package, markers)
        ]


def _build_packages(packages: tuple[InterfacePackage, ...], target: Path) -> None:
    """Build all packages, each into its folder below ``target``."""
    # The generators are only installed for a wheel, but setuptools loads this module for an sdist
    # too.
    from interface_build.package_build import PackageBuild, build_all
    from interface_build.ros_prefix import find_ros_prefix
    from interface_build.work_folder import WorkFolder

    progress = BuildProgress(read_project().name, sys.stderr)
    toolchain = find_toolchain()
    prefix = find_ros_prefix()
    count = sum(len(package.interfaces) for package in packages)
    progress.say(f"building {count} interfaces of {len(packages)} packages")
    builds = [
        PackageBuild(
            package=package,
            work=WorkFolder(scratch_folder("work"), package.name),
            prefix=prefix,
            toolchain=toolchain,
            target=target / package.name,
        )
        for package in packages
    ]
    build_all(builds, progress.report)


def _shared_files(package: InterfacePackage, work: Path) -> list[tuple[str, list[str]]]:
    """List the files for ``share`` by their folder there, in setuptools' form.

    Recorders and command-line tools read definitions there. The markers of the ament index are
    generated into the folder ``work``.
    """
    share = f"share/{package.name}"
    definitions = [
        (
            f"{share}/{kind}",
            [str(package.root / i.source) for i in package.interfaces if i.kind == kind],
        )
        for kind in package.kinds
    ]
    return [
        (share, [str(package.root / "package.xml")]),
        *definitions,
        (f"{_INDEX}/packages", [_write_marker(work / "packages", package.name, "")]),
        (
            f"{_INDEX}/rosidl_interfaces",
            [_write_marker(work / "rosidl_interfaces", package.name, _list_interfaces(package))],
        ),
    ]


def _list_interfaces(package: InterfacePackage) -> str:
    """List the definition files, one per line, for ``interface list``."""
    return "\n".join(interface.source for interface in package.interfaces)


def _write_marker(folder: Path, name: str, content: str) -> str:
    """Write one file of the ament index; return its path."""
    folder.mkdir(parents=True, exist_ok=True)
    path = folder / name
    path.write_text(content, encoding="utf-8")
    return str(path)
