"""The setuptools commands that build the interface packages."""

import sys
from pathlib import Path

from setuptools.command.build import build
from setuptools.command.build_ext import build_ext
from setuptools.command.egg_info import egg_info

from interface_build import share_folder
from interface_build.interface_package import InterfacePackage, find_packages
from interface_build.progress import BuildProgress
from interface_build.project import DEFINITIONS, read_project
from interface_build.scratch import scratch_folder
from interface_build.toolchain import find_toolchain


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
            entry for package in packages for entry in share_folder.data_files(package, markers)
        ]


def _build_packages(packages: tuple[InterfacePackage, ...], target: Path) -> None:
    """Build all packages, each into its folder below ``target``."""
    # The generators are only installed for a wheel, but setuptools loads this module for an sdist
    # too.
    from interface_build.package_build import PackageBuild
    from interface_build.parallel_build import build_all
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
