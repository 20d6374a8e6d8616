"""Makes the first node of a program that knows nothing of this suite as `first_node` makes ours.

A plain rclpy program that is started beside the simulation is to be found at once, and must not
lose its ports either (see `discovery` and `ports`). What starts it calls `reach_first_node`.
"""

import sys
from collections.abc import Sequence
from importlib.machinery import ModuleSpec, PathFinder, SourceFileLoader
from operator import methodcaller
from types import ModuleType
from typing import Any

_RCLPY = "rclpy.impl.implementation_singleton"
"""The module through which rclpy calls its C library; it holds the library as an attribute."""


def reach_first_node() -> None:
    """Apply to the first node that this process creates; call it before rclpy is imported."""
    if _RCLPY not in sys.modules:
        sys.meta_path.insert(0, _RclpyFinder())


class _RclpyFinder:
    """Finds rclpy's C library for the module that holds it."""

    def find_spec(
        self, fullname: str, path: Sequence[str] | None, target: ModuleType | None = None
    ) -> ModuleSpec | None:
        if fullname != _RCLPY:
            return None
        sys.meta_path.remove(self)
        spec = PathFinder.find_spec(fullname, path, target)
        if spec is not None and type(spec.loader) is SourceFileLoader:
            spec.loader = _RclpyLoader(fullname, spec.loader.path)
        return spec


class _RclpyLoader(SourceFileLoader):
    def exec_module(self, module: ModuleType) -> None:
        super().exec_module(module)
        from arm_node.workarounds.discovery import first_node

        library = module.__dict__["rclpy_implementation"]
        make_node = library.Node

        def make_first(*arguments: Any) -> Any:
            library.Node = make_node
            destroy = methodcaller("destroy_when_not_in_use")
            return first_node(lambda: make_node(*arguments), destroy)

        library.Node = make_first
