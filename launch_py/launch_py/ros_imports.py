"""Lets launch files import `launch` and `launch_ros` where those packages are not installed.

Inside `ros_imports()`, `from launch.actions import ExecuteProcess` imports launch_py's class of
that name. Outside it, and if the real package can be imported, nothing changes.
"""

from __future__ import annotations

import sys
from collections.abc import Iterator, Sequence
from contextlib import contextmanager
from importlib import import_module
from importlib.machinery import ModuleSpec
from inspect import isclass, isfunction
from types import ModuleType
from typing import TYPE_CHECKING, Any

from launch_py.near_names import describe_known
from launch_py.ros_names import HOMES, NOT_HERE, OTHER_NAMES

if TYPE_CHECKING:
    from importlib.abc import Loader
else:
    # The import system needs only the methods, and `importlib.abc` imports `tempfile` and more.
    Loader = object


class MissingRosNameError(ImportError):
    """A launch file imports or uses a name that does not exist here; the message says what does."""


class _Absent(type):
    """The class of names that can only be imported: whatever is done with one tells why."""

    def __call__(cls, *_args: object, **_options: object) -> Any:
        raise cls.error()

    def __getattr__(cls, name: str) -> Any:
        raise AttributeError(name) if name.startswith("__") else cls.error()

    def __setattr__(cls, name: str, value: object) -> None:
        raise cls.error()

    def error(cls) -> MissingRosNameError:
        """Return the error that names the reason."""
        return MissingRosNameError(f"{cls.__module__} has no {cls.__name__!r} here; {cls.__doc__}")


@contextmanager
def ros_imports() -> Iterator[None]:
    """Make the names of `launch` and `launch_ros` importable in this context.

    A package that is really installed takes precedence; each package is looked up by itself.
    """
    finder = _Finder()
    sys.meta_path.insert(0, finder)
    try:
        yield
    finally:
        sys.meta_path.remove(finder)
        for name in finder.made:
            sys.modules.pop(name, None)


class _Finder(Loader):
    """Finds and loads the modules of HOMES, unless the package is installed."""

    def __init__(self) -> None:
        self.made: list[str] = []

    def find_spec(
        self, fullname: str, path: Sequence[str] | None = None, target: ModuleType | None = None
    ) -> ModuleSpec | None:
        """Return the spec of a ROS module, None for any other module."""
        top, _, rest = fullname.partition(".")
        if top not in HOMES or (not rest and self._is_installed(top)):
            return None
        if rest and top not in self.made:
            return None  # The real package finds its own modules.
        if fullname not in HOMES and fullname.rpartition(".")[0] not in HOMES:
            raise _missing_module(fullname)
        return ModuleSpec(fullname, self, is_package=True)

    def create_module(self, spec: ModuleSpec) -> ModuleType:
        """Return the module with launch_py's names."""
        home = spec.name
        if home not in HOMES:
            # A module such as launch.actions.timer_action has the names of its parent.
            home = home.rpartition(".")[0]
        self.made.append(spec.name)
        return _RosModule(spec.name, home)

    def exec_module(self, module: ModuleType) -> None:
        """Do nothing: names are looked up on first use."""

    def _is_installed(self, package: str) -> bool:
        for finder in sys.meta_path:
            find = getattr(finder, "find_spec", None)
            if isinstance(finder, _Finder) or find is None:
                continue
            spec = find(package, None)
            # A plain folder launch/ on the path is a namespace package, which has no origin.
            if spec is not None:
                return spec.origin is not None
        return False


class _RosModule(ModuleType):
    """Stands in for a ROS module, with the names that exist here."""

    def __init__(self, name: str, home: str) -> None:
        super().__init__(name, f"The names of {home} that launch_py has.")
        self.__home = home

    def __getattr__(self, name: str) -> Any:
        if name == "__all__":
            return _names(self.__home)
        if name.startswith("__"):
            raise AttributeError(name)
        if f"{self.__name__}.{name}" in HOMES:
            return import_module(f"{self.__name__}.{name}")
        reason = NOT_HERE.get(self.__home, {}).get(name)
        if reason is not None:
            return _Absent(name, (), {"__module__": self.__name__, "__doc__": reason})
        if name not in _names(self.__home):
            raise _missing_name(self.__name__, name, _names(self.__home))
        return _find(self.__home, name)


def _names(home: str) -> list[str]:
    """Return the names that a ROS module has here, sorted."""
    found = {*OTHER_NAMES.get(home, ()), *NOT_HERE.get(home, ())}
    if HOMES[home]:
        module = import_module(HOMES[home])
        found.update(getattr(module, "__all__", None) or _own_names(module))
    return sorted(found)


def _own_names(module: ModuleType) -> list[str]:
    return [
        name
        for name, value in vars(module).items()
        if (isclass(value) or isfunction(value))
        and value.__module__ == module.__name__
        and not name.startswith("_")
    ]


def _find(home: str, name: str) -> Any:
    where, _, there = OTHER_NAMES.get(home, {}).get(name, f"{HOMES[home]}:{name}").partition(":")
    return getattr(import_module(where), there)


def _missing_name(module: str, name: str, known: list[str]) -> MissingRosNameError:
    near = describe_known(name, known)
    reason = near if near.startswith("did you mean") else f"it has {', '.join(known)}"
    return MissingRosNameError(f"{module} has no {name!r} here; {reason}")


def _missing_module(name: str) -> MissingRosNameError:
    near = describe_known(name, HOMES)
    reason = near if near.startswith("did you mean") else f"there are {', '.join(sorted(HOMES))}"
    return MissingRosNameError(f"there is no module {name!r} here; {reason}")
