"""Imports a message class when it is first used, not with its package, and NumPy with an array.

`from sensor_msgs.msg import JointState` imports all 28 messages of the package, the packages of
their fields, and NumPy, which CameraInfo alone needs; the services of every node import NumPy for
an event that nobody sends. That is a third of the processor time of a plain node up to its first
topic, and 13 MB. The first message also imports the generator of such classes, whose parser and
templates no node needs: 60 ms and 4 MB. Made for rclpy 7.1 and 9.1; no upstream issue is known. If
this is switched off, nodes start later and are larger.
"""

import builtins
import re
import sys
from collections.abc import Mapping, Sequence
from importlib import import_module
from importlib.machinery import ModuleSpec, PathFinder, SourceFileLoader
from types import ModuleType
from typing import Any

from arm_node.workarounds.switch import is_on

KINDS = ("msg", "srv", "action")
_LINE = re.compile(r"from (\S+) import (\w+)\s*(?:#.*)?")
_GENERATOR = "rosidl_generator_py"
_GENERATE = "from .generate_py_impl import generate_py"


def import_messages_lazily() -> None:
    """Apply to all message packages that this process imports from now on."""
    if is_on("lazy_messages") and not any(isinstance(f, _MessageFinder) for f in sys.meta_path):
        sys.meta_path.insert(0, _MessageFinder())


class _MessageFinder:
    """Finds PACKAGE.msg, PACKAGE.srv and PACKAGE.action, their modules, and their generator."""

    def find_spec(
        self, fullname: str, path: Sequence[str] | None, target: ModuleType | None = None
    ) -> ModuleSpec | None:
        _, _, rest = fullname.partition(".")
        kind, _, name = rest.partition(".")
        is_generator = fullname == _GENERATOR
        if not is_generator and (kind not in KINDS or path is None):
            return None
        spec = PathFinder.find_spec(fullname, path, target)
        if spec is not None and type(spec.loader) is SourceFileLoader:
            of_messages = _MessageLoader if name else _PackageLoader
            loader = _GeneratorLoader if is_generator else of_messages
            spec.loader = loader(fullname, spec.loader.path)
        return spec


class _GeneratorLoader(SourceFileLoader):
    """Loads the generator of message classes without what only generates."""

    def exec_module(self, module: ModuleType) -> None:
        if _GENERATE not in self.get_data(self.path).decode():
            super().exec_module(module)
            return
        support = import_module(f"{_GENERATOR}.import_type_support_impl")

        def get(name: str) -> Any:
            if name != "generate_py":
                raise AttributeError(f"module {_GENERATOR!r} has no attribute {name!r}")
            return import_module(f"{_GENERATOR}.generate_py_impl").generate_py

        module.__dict__.update(import_type_support=support.import_type_support, __getattr__=get)


class _NumPy:
    """Stands for NumPy in a message's module until it is used."""

    def __getattr__(self, name: str) -> Any:
        return getattr(import_module("numpy"), name)


_NUMPY = _NumPy()


def _import(
    name: str,
    globals: Mapping[str, object] | None = None,
    locals: Mapping[str, object] | None = None,
    fromlist: Sequence[str] = (),
    level: int = 0,
) -> Any:
    if name == "numpy" and not fromlist:
        return _NUMPY
    return builtins.__import__(name, globals, locals, fromlist, level)


class _MessageLoader(SourceFileLoader):
    """Loads the module of a message, whose `import numpy` gets the stand-in."""

    def exec_module(self, module: ModuleType) -> None:
        # Only this module sees the other import statement: `sys.modules` belongs to all threads.
        module.__dict__["__builtins__"] = {**vars(builtins), "__import__": _import}
        super().exec_module(module)


class _PackageLoader(SourceFileLoader):
    """Loads a package of messages without their modules."""

    def exec_module(self, module: ModuleType) -> None:
        modules = _modules_of_classes(self.get_data(self.path).decode())
        if modules is None:
            super().exec_module(module)
            return
        submodules = {name.rpartition(".")[2]: name for name in modules.values()}

        def get(name: str) -> Any:
            if name in submodules:
                return import_module(submodules[name])
            if name not in modules:
                raise AttributeError(f"module {module.__name__!r} has no attribute {name!r}")
            value = getattr(import_module(modules[name]), name)
            setattr(module, name, value)
            return value

        module.__dict__.update(
            __all__=list(modules), __getattr__=get, __dir__=lambda: [*module.__dict__, *modules]
        )


def _modules_of_classes(source: str) -> dict[str, str] | None:
    """Return the modules by the classes that a package imports; None if it does anything else."""
    lines = [line for line in source.splitlines() if line.strip() and not line.startswith("#")]
    found = [_LINE.fullmatch(line) for line in lines]
    return {match[2]: match[1] for match in found if match} if all(found) else None
