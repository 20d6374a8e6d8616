"""Errors of launch_py; every message is a sentence for the person who typed the command.

LaunchError
+-- UsageError             the command line: unknown argument, package, file or choice
+-- LaunchFileError        a launch file that cannot be read or does not make sense
+-- SubstitutionError      a substitution that has no value
+-- NotFoundError          a package, executable or program that does not exist
    +-- UnavailableError   one that is known, but that nothing replaces here
+-- NodeParameterError     a node parameter that cannot be passed on
+-- NodeFileError          a file for a node that has a mistake
+-- StartError             a process that could not be started
"""

from collections.abc import Callable, Iterator
from contextlib import contextmanager
from typing import ClassVar


class LaunchError(Exception):
    """Base class of launch_py's errors.

    Attributes:
        exit_code: exit code of a launch that ends with it before anything starts.
    """

    exit_code: ClassVar[int] = 2


class UsageError(LaunchError):
    """The command line is wrong: an unknown argument, package, file or choice."""


class LaunchFileError(LaunchError):
    """A launch file cannot be read, or what it describes does not make sense."""


class SubstitutionError(LaunchError):
    """A substitution has no value."""


class NotFoundError(LaunchError):
    """A package, an executable or a program does not exist."""


class UnavailableError(NotFoundError):
    """A known executable of ROS has no replacement here; a launch starts without it."""


class NodeParameterError(LaunchError):
    """A node parameter cannot be passed on."""


class NodeFileError(LaunchError):
    """A file that is meant for a node has a mistake; the command line and launch file are right."""

    exit_code = 1


class StartError(LaunchError):
    """A process could not be started."""


@contextmanager
def errors_attributed_to(describe: Callable[[], str]) -> Iterator[None]:
    """Turn any exception that the launch file's own code raises into a LaunchFileError.

    `describe` returns the subject of the error message; it is called only after an exception.

    Raises:
        LaunchFileError: something other than a LaunchError was raised.
    """
    try:
        yield
    except LaunchError:
        raise
    except Exception as error:
        # The launch file is user code and may raise anything.
        # A custom exception carries a sentence; a KeyError needs its type to be understood.
        is_custom = type(error).__module__ != "builtins"
        text = str(error) if is_custom and str(error) else f"{type(error).__name__}: {error}"
        raise LaunchFileError(f"{describe()}: {text}") from error


@contextmanager
def errors_located_at(where: str) -> Iterator[None]:
    """Let an error begin with a place in a launch file, unless it already names a line.

    A UsageError is about the command line, so it stays as it is.
    """
    try:
        yield
    except (UsageError, NodeFileError):
        raise
    except LaunchError as error:
        if where and ", line " not in str(error):
            error.args = (f"{where}: {error}",)
        raise
