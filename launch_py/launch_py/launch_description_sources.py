"""Where launch descriptions come from."""

from __future__ import annotations

import os
from pathlib import Path
from types import ModuleType
from typing import TYPE_CHECKING

from launch_py.errors import LaunchError, LaunchFileError, NotFoundError
from launch_py.near_names import describe_known
from launch_py.substitution import Text, describe_text, perform_text

if TYPE_CHECKING:
    from launch_py.launch_context import LaunchContext
    from launch_py.launch_description import LaunchDescription


class LaunchDescriptionSource:
    """A launch file somewhere."""

    def __init__(self, location: Text) -> None:
        self.location = location

    def path(self, context: LaunchContext) -> Path:
        """Return the file's absolute path.

        Raises:
            LaunchError: the location has no value.
        """
        return Path(os.path.abspath(perform_text(context, self.location)))

    def describe(self) -> str:
        """Return the location as it is written."""
        return describe_text(self.location)


class PythonLaunchDescriptionSource(LaunchDescriptionSource):
    """A Python launch file: it defines `generate_launch_description()`."""


class AnyLaunchDescriptionSource(LaunchDescriptionSource):
    """A launch file of any kind that can be read; Python is the only one."""


def read_launch_file(path: Path) -> LaunchDescription:
    """Run a launch file and return its description.

    Raises:
        NotFoundError: there is no such file.
        LaunchFileError: it is not Python, has no `generate_launch_description`, or fails.
    """
    from launch_py.launch_description import LaunchDescription

    if not path.is_file():
        siblings = [p.name for p in path.parent.glob("*.py")] if path.parent.is_dir() else []
        known = describe_known(path.name, siblings, f"{path.parent} holds")
        raise NotFoundError(f"no launch file {path}; {known}")
    if path.suffix != ".py":
        raise LaunchFileError(
            f"{path} is not a Python launch file; XML and YAML launch files are not supported"
        )
    module = ModuleType(path.name.replace(".", "_"))
    module.__file__ = str(path)
    try:
        # Compiled by hand: an import would leave a __pycache__ in the installed share folder.
        exec(compile(path.read_text(encoding="utf-8"), str(path), "exec"), module.__dict__)
        generate = getattr(module, "generate_launch_description", None)
        if generate is None:
            raise LaunchFileError(f"{path} does not define generate_launch_description()")
        description = generate()
    except LaunchError:
        raise
    except Exception as error:
        # A SyntaxError's text names file and line once more.
        what = error.msg if isinstance(error, SyntaxError) else error
        raise LaunchFileError(f"{_where(error, path)}: {type(error).__name__}: {what}") from error
    if not isinstance(description, LaunchDescription):
        raise LaunchFileError(
            f"generate_launch_description() of {path} returns "
            f"{type(description).__name__}, not LaunchDescription"
        )
    return description


def _where(error: BaseException, path: Path) -> str:
    """Return file and line in the launch file where an error came from."""
    if isinstance(error, SyntaxError) and error.filename == str(path):
        return f"{path}, line {error.lineno}"
    line = None
    traceback = error.__traceback__
    while traceback is not None:
        if traceback.tb_frame.f_code.co_filename == str(path):
            line = traceback.tb_lineno
        traceback = traceback.tb_next
    return f"{path}, line {line}" if line else str(path)
