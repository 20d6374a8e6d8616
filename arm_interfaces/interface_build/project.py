"""The distribution that is built.

Several distributions share this package: the others have a link to it beside their own
``pyproject.toml``, so the folder in which it is imported tells which of them is built.
"""

import functools
import os
import tomllib
from dataclasses import dataclass
from pathlib import Path

_FOLDER = Path(__file__).parent.parent
DEFINITIONS = _FOLDER / "interfaces"
"""The folder of the definitions, one folder per package."""


@dataclass(frozen=True, slots=True)
class Project:
    """What ``pyproject.toml`` says, for the ROS 2 distribution that ROS_DISTRO names.

    Attributes:
        name: the distribution's name as messages show it, such as ``arm_interfaces``.
        dependencies: what it needs at run time, as requirements.
    """

    name: str
    dependencies: tuple[str, ...]


@functools.cache
def read_project() -> Project:
    """Read ``pyproject.toml``.

    Raises:
        SystemExit: ROS_DISTRO names a distribution without wheels.
    """
    table = tomllib.loads((_FOLDER / "pyproject.toml").read_text(encoding="utf-8"))
    name, build = table["project"]["name"].replace("-", "_"), table["tool"]["interface_build"]
    wheels: dict[str, list[str]] = build["ros"]
    chosen = os.environ.get("ROS_DISTRO") or next(iter(wheels))
    if chosen not in wheels:
        raise SystemExit(
            f"ROS_DISTRO is {chosen!r}, but {name} is built for {' or '.join(wheels)} only; "
            "set it to one of them, or unset it"
        )
    return Project(name, (*wheels[chosen], *build["dependencies"]))
