"""Errors of launch_py; every message is a sentence for the person who typed the command.

LaunchError
+-- UsageError             the command line: unknown argument, package, file or choice
+-- LaunchFileError        a launch file that cannot be read or does not make sense
+-- SubstitutionError      a substitution that has no value
+-- NotFoundError          a package, executable or program that does not exist
+-- ParameterError         a node parameter that cannot be passed on
+-- StartError             a process that could not be started
"""

from collections.abc import Callable, Iterator
from contextlib import contextmanager


class LaunchError(Exception):
    """Root of the errors of launch_py."""


class UsageError(LaunchError):
    """What was typed on the command line does not fit what exists."""


class LaunchFileError(LaunchError):
    """A launch file cannot be read, or what it describes does not make sense."""


class SubstitutionError(LaunchError):
    """A substitution has no value."""


class NotFoundError(LaunchError):
    """A package, an executable or a program does not exist."""


class ParameterError(LaunchError):
    """A node parameter cannot be passed on."""


class StartError(LaunchError):
    """A process could not be started."""


@contextmanager
def blaming(describe: Callable[[], str]) -> Iterator[None]:
    """Turn whatever a mistake of a launch file raises inside into a sentence.

    Args:
        describe: returns whom to blame; asked only then.

    Raises:
        LaunchFileError: something other than a LaunchError was raised.
    """
    try:
        yield
    except LaunchError:
        raise
    except Exception as error:
        # An error class of somebody's own comes with a sentence; KeyError and the like do not.
        own = type(error).__module__ != "builtins"
        text = str(error) if own and str(error) else f"{type(error).__name__}: {error}"
        raise LaunchFileError(f"{describe()}: {text}") from error
