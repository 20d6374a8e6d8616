"""The hooks that pip calls: setuptools' own, after checks that the build is possible."""

import platform
import sys
from collections.abc import Mapping

from setuptools import build_meta

from interface_build.errors import BuildError
from interface_build.project import read_project
from interface_build.toolchain import find_toolchain

build_sdist = build_meta.build_sdist
get_requires_for_build_sdist = build_meta.get_requires_for_build_sdist
prepare_metadata_for_build_wheel = build_meta.prepare_metadata_for_build_wheel

# The generators accept any EmPy, but the next major version may not run their templates.
_BUILD_ONLY = ["empy>=4.2,<5"]

_Settings = Mapping[str, str | list[str] | None] | None


def get_requires_for_build_wheel(config_settings: _Settings = None) -> list[str]:
    """Check for the compilers, then require the packages' run-time dependencies.

    The generators, headers and libraries are in the same wheels as the run time and must have the
    same version, so one list serves both.
    """
    _check_machine()
    own = build_meta.get_requires_for_build_wheel(config_settings)
    return [*own, *_BUILD_ONLY, *read_project().dependencies]


def build_wheel(
    wheel_directory: str,
    config_settings: _Settings = None,
    metadata_directory: str | None = None,
) -> str:
    """Build the wheel; a build error becomes one message instead of a traceback."""
    try:
        return build_meta.build_wheel(wheel_directory, config_settings, metadata_directory)
    except BuildError as error:
        raise SystemExit(str(error)) from error


def get_requires_for_build_editable(config_settings: _Settings = None) -> list[str]:
    """Refuse before anything is downloaded."""
    raise SystemExit(_not_editable())


def build_editable(
    wheel_directory: str,
    config_settings: _Settings = None,
    metadata_directory: str | None = None,
) -> str:
    """Refuse; pip looks for this hook before it calls the one for its requirements."""
    raise SystemExit(_not_editable())


def _not_editable() -> str:
    """Say why an editable installation is refused."""
    return (
        f"{read_project().name} cannot be installed editable, because its modules are compiled and "
        "not in the source tree; install it without -e, and again after changing a definition"
    )


def _check_machine() -> None:
    """Exit with one sentence if the ROS 2 wheels or the compilers are missing."""
    if sys.platform != "linux" or platform.machine() != "x86_64":
        raise SystemExit(
            f"{read_project().name} needs the ROS 2 wheels, which exist for Linux on x86_64 only; "
            f"this is {sys.platform} on {platform.machine()}"
        )
    try:
        find_toolchain()
    except BuildError as error:
        raise SystemExit(str(error)) from error
