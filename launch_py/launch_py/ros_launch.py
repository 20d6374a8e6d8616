"""Launch descriptions that ROS 2's own `launch` reads: each becomes one process of `arm launch`.

ROS 2's launch has no readiness conditions, restart policies and panels. There, a description
declares its arguments, and starts this package's launcher with its file.
"""

from __future__ import annotations

import inspect
import os
import sys
from collections.abc import Callable, Iterable, Iterator, Mapping
from contextlib import contextmanager
from contextvars import ContextVar
from functools import cache
from pathlib import Path
from types import ModuleType
from typing import Any

from launch_py.errors import LaunchFileError
from launch_py.launch_context import ArgumentInfo

STOP_S = "30"
"""How long the launcher may take to stop its processes in order, before ROS 2's launch kills it."""

_READING: ContextVar[bool] = ContextVar("reading", default=False)


@contextmanager
def read_by_launch_py() -> Iterator[None]:
    """Make descriptions ordinary in this context, even where ROS 2's `launch` is imported."""
    token = _READING.set(True)
    try:
        yield
    finally:
        _READING.reset(token)


def reading_launch() -> ModuleType | None:
    """Return ROS 2's `launch` if it is what reads a launch file now."""
    module = sys.modules.get("launch")
    is_real = module is not None and getattr(module, "__file__", None) is not None
    return module if is_real and not _READING.get() else None


def calling_launch_file() -> Path:
    """Return the launch file whose code is running.

    Raises:
        LaunchFileError: the description is not made in a launch file.
    """
    frame = inspect.currentframe()
    while frame is not None:
        path = frame.f_code.co_filename
        if path.endswith("launch.py") and path != __file__ and os.path.isfile(path):
            return Path(os.path.abspath(path))
        frame = frame.f_back
    raise LaunchFileError(
        "ROS 2's `launch` reads this description, which is not in a file FILE.launch.py: start it "
        "with `arm launch`"
    )


@cache
def bridged(description: type, launch: ModuleType, survey: Callable[..., Any]) -> type:
    """Return a class that is both a description of this package and of ROS 2's `launch`.

    Args:
        description: the class `LaunchDescription` of this package.
        launch: ROS 2's package.
        survey: the function `survey_description` of this package.
    """
    bases: tuple[Any, ...] = (description, launch.LaunchDescription)

    class BridgedDescription(*bases):  # pyright: ignore[reportUntypedBaseClass]
        """Declares the arguments, and starts `arm launch` with the file; see the module."""

        def __init__(self, *args: Any, **options: Any) -> None:
            launch.LaunchDescription.__init__(self)
            description.__init__(self, *args, **options)
            self._file = calling_launch_file()

        @property
        def entities(self) -> list[Any]:
            """The entities for ROS 2's `launch`: the declarations, and the process."""
            return [*self._declarations(), self._process({})]

        def describe_sub_entities(self) -> list[Any]:
            """Return what introspection and including files see."""
            return self.entities

        def get_launch_arguments_with_include_launch_description_actions(
            self, conditional_inclusion: bool = False
        ) -> list[tuple[Any, Any]]:
            """Return a declaration of each argument, as one of this file's own."""
            return [(declaration, None) for declaration in self._declarations()]

        def visit(self, context: Any) -> Any:
            """Return the entities for ROS 2's `launch`; with this package's context, expand."""
            if not isinstance(context, launch.LaunchContext):
                return description.visit(self, context)
            known = context.launch_configurations
            given = {a.name: known[a.name] for a in self._arguments() if a.name in known}
            return [*self._declarations(), self._process(given)]

        def _arguments(self) -> Iterable[ArgumentInfo]:
            with read_by_launch_py():
                return survey(self, os.environ, self._file).arguments.values()

        def _declarations(self) -> list[Any]:
            return [_declaration(launch, argument) for argument in self._arguments()]

        def _process(self, given: dict[str, str]) -> Any:
            return _launcher(launch, self._file, given)

    return BridgedDescription


def _declaration(launch: ModuleType, argument: ArgumentInfo) -> Any:
    return launch.actions.DeclareLaunchArgument(
        argument.name,
        default_value=argument.default,
        description=argument.description,
        choices=list(argument.choices) or None,
    )


def _launcher(launch: ModuleType, file: Path, arguments: Mapping[str, str]) -> Any:
    words = [f"{name}:={value}" for name, value in arguments.items()]
    return launch.actions.ExecuteProcess(
        cmd=[sys.executable, "-m", "launch_py", str(file), *words],
        name=file.name.partition(".")[0],
        output="screen",
        sigterm_timeout=STOP_S,
    )
