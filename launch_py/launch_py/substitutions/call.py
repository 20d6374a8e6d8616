"""A substitution computed by a Python function."""

from __future__ import annotations

from collections.abc import Callable
from typing import TYPE_CHECKING

from launch_py.errors import blaming
from launch_py.substitution import Substitution, Text, perform_text

if TYPE_CHECKING:
    from launch_py.launch_context import LaunchContext


class Call(Substitution):
    """What `function` returns for the performed texts, as text.

    Arguments and keyword arguments are texts with substitutions; the function gets plain strings.
    Unlike `Command` it starts no process. It runs each time it is performed: keep a costly result
    with `SetLaunchConfiguration` and refer to that.
    """

    is_costly = True

    def __init__(self, function: Callable[..., object], *args: Text, **kwargs: Text) -> None:
        self.function = function
        self.args = args
        self.kwargs = kwargs

    def perform(self, context: LaunchContext) -> str:
        """Return the result.

        Raises:
            LaunchFileError: the function raised something; the message says what.
        """
        args = [perform_text(context, value) for value in self.args]
        kwargs = {name: perform_text(context, value) for name, value in self.kwargs.items()}
        with blaming(self.describe):
            return str(self.function(*args, **kwargs))

    def describe(self) -> str:
        """Return how it is written."""
        return f"Call({getattr(self.function, '__name__', 'function')})"
