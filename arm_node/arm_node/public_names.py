"""The public names of a package, each imported on its first use.

The package's `__init__.py` lists them once, where type checkers look for them, in lines such as
`from arm_sim.goals import Goal as Goal` below `if TYPE_CHECKING:`.
"""

import re
import sys
from collections.abc import Callable
from functools import cache
from importlib import import_module
from pathlib import Path
from typing import Any

_PUBLIC_NAME = re.compile(r"^    from (\S+) import (\w+) as \2$", re.MULTILINE)


def on_first_use(package: str) -> tuple[Callable[[str], Any], Callable[[], list[str]]]:
    """Return the `__getattr__` and `__dir__` of a package, which also has an `__all__` then."""
    own = sys.modules[package]

    @cache
    def modules() -> dict[str, str]:
        text = Path(str(own.__file__)).read_text(encoding="utf-8")
        return {name: module for module, name in _PUBLIC_NAME.findall(text)}

    def import_name(name: str) -> Any:
        if name == "__all__":
            return sorted(modules())
        if name not in modules():
            raise AttributeError(f"module '{package}' has no attribute '{name}'")
        value = getattr(import_module(modules()[name]), name)
        setattr(own, name, value)
        return value

    return import_name, lambda: sorted({*vars(own), *modules()})
