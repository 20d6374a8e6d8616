"""Decides which workarounds are on: by the version of the library, and by ARM_WITHOUT."""

import os
import re
import sys
from collections.abc import Callable, Mapping
from functools import cache
from pathlib import Path

from arm_node.frozen import frozen

VARIABLE = "ARM_WITHOUT"
ALL = "all"
_VERSION = re.compile(r"<version[^>]*>\s*([\d.]+)\s*</version>")
_RMW = "rmw_fastrtps"


@frozen
class Library:
    """A library that has workarounds.

    Attributes:
        name: the name in messages.
        made_for: the beginnings of the versions that the workarounds are made for.
        find_version: returns the version in use: empty if it is unknown or another library is
            used instead, None if this process has not loaded the library.
    """

    name: str
    made_for: tuple[str, ...]
    find_version: Callable[[], str | None]

    @property
    def fits(self) -> bool:
        """Whether the workarounds are made for the version in use."""
        return f"{self.find_version()}.".startswith(tuple(f"{one}." for one in self.made_for))

    def __str__(self) -> str:
        """Return the name and the versions that the workarounds are made for."""
        return f"{self.name} {' and '.join(self.made_for)}"


@cache
def _rmw_version() -> str:
    in_use = os.environ.get("RMW_IMPLEMENTATION", _RMW).startswith(_RMW)
    return _package_version(f"{_RMW}_cpp") if in_use else ""


@cache
def _rclpy_version() -> str:
    return _package_version("rclpy")


def _mujoco_version() -> str | None:
    mujoco = sys.modules.get("mujoco")
    return None if mujoco is None else str(mujoco.__version__)


def _package_version(name: str) -> str:
    """Return the version of the first ROS package with this name; empty if there is none."""
    prefixes = os.environ.get("AMENT_PREFIX_PATH", "").split(os.pathsep)
    for prefix in filter(None, [*prefixes, sys.prefix]):
        # `importlib.metadata` takes ten times as long, and does not find a sourced ROS 2.
        try:
            text = Path(prefix, "share", name, "package.xml").read_text(encoding="utf-8")
        except (OSError, ValueError):
            continue
        found = _VERSION.search(text)
        return found[1] if found else ""
    return ""


RMW = Library("rmw_fastrtps", ("8.4", "9.3"), _rmw_version)
"""The versions of ROS 2 Jazzy, which uses Fast DDS 2.14, and Kilted, which uses 3.2."""
RCLPY = Library("rclpy", ("7.1", "9.1"), _rclpy_version)
MUJOCO = Library("MuJoCo", ("4.0",), _mujoco_version)

FIRST_ON_FAST_DDS_3 = 9
"""The first major version of rmw_fastrtps that uses Fast DDS 3."""

LIBRARIES: Mapping[str, Library] = {
    "discovery": RMW,
    "signs_of_life": RMW,
    "torn_ports": RMW,
    "lost_ports": RMW,
    "exit_pause": RMW,
    "deadlocked_end": RMW,
    "private_files": RMW,
    "local_profile": RMW,
    "message_template": RCLPY,
    "stamp_clock": RCLPY,
    "process_clock": RCLPY,
    "joint_state_encoding": RCLPY,
    "parameter_types": RCLPY,
    "lazy_messages": RCLPY,
    "serialized_goals": RCLPY,
    "profiler": MUJOCO,
    "patch_releases": MUJOCO,
}
"""The library of each workaround, by the workaround's name."""

OF_THE_BUILD = ("parse_cache", "template_cache")
"""The workarounds in the build of arm_interfaces, which imports no package of the suite."""


def uses_fast_dds_3() -> bool:
    """Return whether the middleware of this process is Fast DDS 3, and not 2 or another."""
    major = (RMW.find_version() or "").partition(".")[0]
    return major.isdecimal() and int(major) >= FIRST_ON_FAST_DDS_3


@cache
def is_on(name: str) -> bool:
    """Return whether a workaround of `LIBRARIES` is on; decided once in each process."""
    return not is_off_by_hand(name, os.environ) and LIBRARIES[name].fits


def switched_off(environ: Mapping[str, str] = os.environ) -> str:
    """Return a line with the workarounds that are off, and why; empty if all are on."""
    reasons: dict[str, list[str]] = {}
    for name, library in LIBRARIES.items():
        if is_off_by_hand(name, environ):
            reasons.setdefault(f"by {VARIABLE}", []).append(name)
        elif not library.fits and (version := library.find_version()) is not None:
            found = version or "unknown or not in use"
            why = f"made for {library}; the version here is {found}"
            reasons.setdefault(why, []).append(name)
    parts = [f"{', '.join(names)} ({why})" for why, names in reasons.items()]
    unknown = sorted(_named(environ) - {*LIBRARIES, *OF_THE_BUILD, ALL})
    if unknown:
        known = ", ".join([*LIBRARIES, *OF_THE_BUILD])
        parts.append(f"unknown in {VARIABLE}: {', '.join(unknown)}; the names are {known}")
    return f"workarounds that are off: {'; '.join(parts)}" if parts else ""


def is_off_by_hand(name: str, environ: Mapping[str, str] = os.environ) -> bool:
    """Return whether ARM_WITHOUT names a workaround."""
    return not _named(environ).isdisjoint({name, ALL})


def _named(environ: Mapping[str, str]) -> set[str]:
    words = environ.get(VARIABLE, "").split(",")
    return {word.strip() for word in words} - {""}
