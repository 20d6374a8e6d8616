"""Where launch descriptions come from: launch files, and the action that includes them."""

from __future__ import annotations

import os
from pathlib import Path
from types import ModuleType

from launch_py.action import LAUNCH_FILE, Action
from launch_py.conditions import Condition
from launch_py.errors import LaunchError, LaunchFileError, NotFoundError, errors_located_at
from launch_py.launch_context import LaunchContext, LaunchSurvey
from launch_py.launch_description import LaunchDescription
from launch_py.ros_imports import MissingRosNameError, ros_imports
from launch_py.ros_launch import read_by_launch_py
from launch_py.substitution import (
    LaunchScope,
    Pairs,
    Text,
    describe_text,
    keep_pairs,
    perform_pairs,
    perform_text,
)
from launch_py.system.packages import Packages, describe_missing_launch_file
from launch_py.system.programs import NOTHING

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
        # Imported late, because most launch files are Python.
        from launch_py.frontend.elements import read_description

        return read_description(path, IncludeLaunchDescription)
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
            exec(compile(path.read_bytes(), str(path), "exec"), module.__dict__)
            generate = getattr(module, "generate_launch_description", None)
            if generate is None:
                raise LaunchFileError(f"{path} does not define generate_launch_description()")
            description = generate()
    except LaunchError as error:
        where = _where(error, path)
        with errors_located_at(where if ", line " in where else ""):
            raise
    except MissingRosNameError as error:
        raise LaunchFileError(f"{_where(error, path)}: {error}") from error
    except ModuleNotFoundError as error:
        raise LaunchFileError(f"{_where(error, path)}: {_missing_module(error)}") from error
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


def _missing_module(error: ModuleNotFoundError) -> str:
    """Return the error about a module that cannot be imported, and what there is instead."""
    package = (error.name or "").partition(".")[0]
    found = Packages(os.environ).stand_in_of(package, package)
    instead = f"; {found.words[0]}" if found is not None and found.kind == NOTHING else ""
    return f"{type(error).__name__}: {error}{instead}"


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


MAX_DEPTH = 20
"""Launch files that are nested deeper than this are taken for a cycle of includes."""

Source = LaunchDescriptionSource | LaunchDescription | Text


class IncludeLaunchDescription(Action):
    """The actions of another launch file, in a scope of their own.

    The included file sees the arguments of the including file, overridden by `launch_arguments`.
    Unlike in ROS, its settings do not leak back, and there is a warning of an argument that nothing
    in it reads.
    """

    def __init__(
        self,
        launch_description_source: Source,
        *,
        launch_arguments: Pairs | None = None,
        condition: Condition | None = None,
    ) -> None:
        super().__init__(condition=condition)
        if not isinstance(launch_description_source, LaunchDescriptionSource | LaunchDescription):
            launch_description_source = PythonLaunchDescriptionSource(launch_description_source)
        self.source = launch_description_source
        self.launch_arguments = keep_pairs(launch_arguments)
        self._read: tuple[Path, LaunchDescription] | None = None

    def expand(self, context: LaunchContext) -> None:
        """Expand the included actions."""
        arguments = dict(perform_pairs(context, self.launch_arguments, "launch_arguments="))
        path, description = self._load(context)
        inner = context.included(path)
        if len(inner.included_files) > MAX_DEPTH:
            raise LaunchFileError(f"launch files include each other in a cycle: {path}")
        survey = LaunchSurvey()
        if arguments:
            description.survey(survey, inner.surveyed())
        given = inner.fix_arguments(arguments)
        description.visit(inner)
        inner.warn_of_unread(given, survey.arguments, self.describe())

    def survey(self, survey: LaunchSurvey, context: LaunchContext) -> None:
        """Survey the included actions if the file can be found without expanding anything."""
        super().survey(survey, context)
        try:
            path, description = self._load(context)
            arguments = dict(perform_pairs(context, self.launch_arguments, "launch_arguments="))
        except LaunchError:
            return
        if path is None or path not in context.included_files:
            inner = context.included(path)
            inner.fix_arguments(arguments)
            description.survey(survey, inner)

    def _load(self, context: LaunchContext) -> tuple[Path | None, LaunchDescription]:
        if isinstance(self.source, LaunchDescription):
            return context.launch_file, self.source
        path = self.source.path(context)
        # The survey and the expansion must see the same actions, so the file is read once. It is
        # kept here and not in the source: two includes of one file are two robots.
        if self._read is None or self._read[0] != path:
            self._read = (path, read_launch_file(path))
        return self._read

    def describe(self) -> str:
        """Return its name in messages."""
        if isinstance(self.source, LaunchDescription):
            return "an included launch description"
        return f"the include of {self.source.describe()}"
