"""Where launch descriptions come from."""

from __future__ import annotations

import os
from importlib import import_module
from pathlib import Path
from types import ModuleType

from launch_py.action import LAUNCH_FILE
from launch_py.errors import LaunchError, LaunchFileError, NotFoundError
from launch_py.launch_description import LaunchDescription
from launch_py.ros_imports import MissingRosNameError, ros_imports
from launch_py.ros_launch import read_by_launch_py
from launch_py.substitution import LaunchScope, Text, describe_text, perform_text
from launch_py.system.packages import Packages, describe_missing_launch_file

FRONTEND_ENDINGS = (".xml", ".launch", ".yaml", ".yml")
"""What XML and YAML launch files end with; .launch is XML."""


class LaunchDescriptionSource:
    """The location of a launch file."""

    def __init__(self, location: Text) -> None:
        self.location = location

    def path(self, context: LaunchScope) -> Path:
        """Return the file's absolute path.

        Raises:
            LaunchError: a substitution in the location has no value.
        """
        return Path(os.path.abspath(perform_text(context, self.location)))

    def describe(self) -> str:
        """Return the location as it is written."""
        return describe_text(self.location)


class PythonLaunchDescriptionSource(LaunchDescriptionSource):
    """A Python launch file: it defines `generate_launch_description()`."""


class AnyLaunchDescriptionSource(LaunchDescriptionSource):
    """A launch file in any supported format, told by its ending; see `read_launch_file`."""


class FrontendLaunchDescriptionSource(AnyLaunchDescriptionSource):
    """An XML or YAML launch file."""


class XMLLaunchDescriptionSource(FrontendLaunchDescriptionSource):
    """An XML launch file."""


class YAMLLaunchDescriptionSource(FrontendLaunchDescriptionSource):
    """A YAML launch file."""


def read_launch_file(path: Path | str) -> LaunchDescription:
    """Read a launch file and return its description; the file's ending tells its format.

    Raises:
        NotFoundError: there is no such file.
        LaunchFileError: the file is not Python, XML or YAML, or is invalid.
    """
    path = Path(path)
    if not os.path.isfile(path):
        raise NotFoundError(describe_missing_launch_file(path, Packages(os.environ)))
    if path.suffix == ".py":
        return _read_python(path)
    if path.suffix in FRONTEND_ENDINGS:
        # Imported by name, because its actions include files, which are read here.
        return import_module("launch_py.frontend.elements").read_description(path)
    raise LaunchFileError(
        f"{path} does not end like a launch file: .py, {', '.join(FRONTEND_ENDINGS)}"
    )


def _read_python(path: Path) -> LaunchDescription:
    """Run a Python launch file; see `read_launch_file`."""
    module = ModuleType(path.name.replace(".", "_"))
    module.__file__ = module.__dict__[LAUNCH_FILE] = str(path)
    try:
        # Compiled by hand: an import would leave a __pycache__ in the installed share folder.
        with ros_imports(), read_by_launch_py():
            exec(compile(path.read_text(encoding="utf-8"), str(path), "exec"), module.__dict__)
            generate = getattr(module, "generate_launch_description", None)
            if generate is None:
                raise LaunchFileError(f"{path} does not define generate_launch_description()")
            description = generate()
    except LaunchError:
        raise
    except MissingRosNameError as error:
        raise LaunchFileError(f"{_where(error, path)}: {error}") from error
    except (Exception, SystemExit) as error:
        # A launch file is user code and may raise anything. One that exits describes no launch.
        # The text of a SyntaxError would repeat the file and the line.
        what = error.msg if isinstance(error, SyntaxError) else error
        raise LaunchFileError(f"{_where(error, path)}: {type(error).__name__}: {what}") from error
    if not isinstance(description, LaunchDescription):
        kind = type(description)
        if kind.__module__.partition(".")[0] == "launch":
            raise LaunchFileError(
                f"{path} imports the `launch` of an installed ROS 2: start it with `ros2 launch`, "
                "or import from launch_py"
            )
        raise LaunchFileError(
            f"generate_launch_description() of {path} returns "
            f"{kind.__name__}, not LaunchDescription"
        )
    return description


def _where(error: BaseException, path: Path) -> str:
    """Return the launch file and the line that raised an error."""
    if isinstance(error, SyntaxError) and error.filename == str(path):
        return f"{path}, line {error.lineno}"
    line = None
    traceback = error.__traceback__
    while traceback is not None:
        if traceback.tb_frame.f_code.co_filename == str(path):
            line = traceback.tb_lineno
        traceback = traceback.tb_next
    return f"{path}, line {line}" if line else str(path)
