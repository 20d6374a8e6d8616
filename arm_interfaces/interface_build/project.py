"""The distribution that is built.

Several distributions share this package: the others have a link to it beside their own
``pyproject.toml``, so the folder in which it is imported tells which of them is built.
"""

import functools
import tomllib
from dataclasses import dataclass
from pathlib import Path

_FOLDER = Path(__file__).parent.parent
DEFINITIONS = _FOLDER / "interfaces"
"""The folder of the definitions, one folder per package."""


@dataclass(frozen=True, slots=True)
class Project:
    """What ``pyproject.toml`` says.

    Attributes:
        name: the distribution's name as messages show it, such as ``arm_interfaces``.
        dependencies: what it needs at run time, as requirements.
    """

    name: str
    dependencies: tuple[str, ...]


@functools.cache
def read_project() -> Project:
    """Read ``pyproject.toml``."""
    text = (_FOLDER / "pyproject.toml").read_text(encoding="utf-8")
    table = tomllib.loads(text)["project"]
    return Project(table["name"].replace("-", "_"), tuple(table["dependencies"]))
