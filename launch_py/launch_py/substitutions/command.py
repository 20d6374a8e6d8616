"""Substitutions that run a program or a function, or evaluate an expression."""

from __future__ import annotations

from collections.abc import Callable
from importlib import import_module
from os import PathLike
from typing import Any, Literal
from warnings import catch_warnings

from launch_py.errors import LaunchError, NotFoundError, SubstitutionError, errors_attributed_to
from launch_py.substitution import LaunchScope, Substitution, Text, describe_text, perform_text
from launch_py.system.child_environment import for_program
from launch_py.system.packages import Packages
from launch_py.system.programs import find_program

OnStderr = Literal["fail", "ignore", "warn", "capture"]


class FindExecutable(Substitution):
    """The path of a program on PATH, or beside this Python."""

    def __init__(self, *, name: Text) -> None:
        self.name = name

    def perform(self, context: LaunchScope) -> str:
        """Return the path.

        Raises:
            NotFoundError: there is no such program.
        """
        return find_program(
            perform_text(context, self.name), context.environment_variable("PATH") or ""
        )

    def describe(self) -> str:
        """Return the substitution as a launch file writes it."""
        return f"FindExecutable({describe_text(self.name)!r})"


class Command(Substitution):
    """The output of a command, run while the launch file is expanded.

    The joined text is split into words as by a shell, but run without one. Starting a Python
    process takes a quarter of a second; use `Call` if the work is a Python function.
    """

    is_costly = True

    def __init__(self, command: Text, *, on_stderr: OnStderr = "fail") -> None:
        self.command = command
        self.on_stderr = on_stderr

    def perform(self, context: LaunchScope) -> str:
        """Return the standard output, without its last newline.

        Raises:
            SubstitutionError: the command failed, or wrote to stderr and `on_stderr` is "fail".
        """
        import shlex
        import subprocess

        text = perform_text(context, self.command)
        try:
            words = shlex.split(text)
        except ValueError as error:
            raise SubstitutionError(f"command {text!r} cannot be split: {error}") from error
        if not words:
            raise SubstitutionError("Command has no text")
        path = context.environment_variable("PATH") or ""
        try:
            words[0] = find_program(words[0], path)
        except NotFoundError as error:
            if len(words) > 1 or isinstance(self.command, str):
                raise
            hint = "Command joins its parts without spaces: is one missing, as in 'xacro '?"
            raise NotFoundError(f"{error}; {hint}") from error
        # Also looks up a full path, because FindExecutable(name="xacro") returns one.
        words[:1] = Packages({}).stand_in(words[0]) or (words[0],)
        done = subprocess.run(
            words,
            capture_output=True,
            text=True,
            check=False,
            env=for_program(words[0], context.complete_environment()),
        )
        complaint = done.stderr.strip().replace("\n", "\n  ")
        if done.returncode != 0:
            raise SubstitutionError(
                f"command {text!r} ended with exit code {done.returncode}"
                + (f": {complaint}" if complaint else "")
            )
        if complaint and self.on_stderr == "fail":
            raise SubstitutionError(f"command {text!r} complained: {complaint}")
        if complaint and self.on_stderr == "warn":
            context.warnings.append(f"command {text!r} complained: {complaint}")
        output = done.stdout + (done.stderr if self.on_stderr == "capture" else "")
        return output.removesuffix("\n")

    def describe(self) -> str:
        """Return the substitution as a launch file writes it."""
        return f"Command({describe_text(self.command)!r})"


class Call(Substitution):
    """The result of a Python function, as text.

    Arguments and keyword arguments are texts with substitutions; the function gets plain strings.
    Unlike `Command` it starts no process. The function runs each time the substitution is
    performed: store a costly result with `SetLaunchConfiguration`.
    """

    is_costly = True

    def __init__(self, function: Callable[..., object], *args: Text, **kwargs: Text) -> None:
        self.function = function
        self.args = args
        self.kwargs = kwargs

    def perform(self, context: LaunchScope) -> str:
        """Return the result.

        Raises:
            LaunchFileError: the function raised an exception; the message names it.
        """
        args = [perform_text(context, value) for value in self.args]
        kwargs = {name: perform_text(context, value) for name, value in self.kwargs.items()}
        with errors_attributed_to(self.describe):
            return str(self.function(*args, **kwargs))

    def describe(self) -> str:
        """Return the substitution as a launch file writes it."""
        return f"Call({getattr(self.function, '__name__', 'function')})"


NAMES = {"true": True, "false": False}
"""Launch arguments spell booleans in lower case; to Python these would be unknown names."""


class PythonExpression(Substitution):
    """The value of a Python expression, as text.

    A Python launch file is a program, so any expression is evaluated. `$(eval ...)` in XML, YAML
    and parameter files is a `SafeExpression`.

    Args:
        expression: the expression.
        python_modules: modules that the expression uses by their names; the names in `math` can
            also be used without it.
    """

    def __init__(self, expression: Text, python_modules: Text = ("math",)) -> None:
        self.expression = expression
        single = isinstance(python_modules, str | PathLike | Substitution)
        self.python_modules = [python_modules] if single else list(python_modules)

    def perform(self, context: LaunchScope) -> str:
        """Return the value as text.

        Raises:
            SubstitutionError: there is no such module, or evaluating raises an error.
        """
        text = perform_text(context, self.expression)
        names: dict[str, Any] = dict(NAMES)
        try:
            for part in self.python_modules:
                name = perform_text(context, part)
                module = import_module(name)
                if name == "math":
                    names |= vars(module)
                names[name] = module
            with catch_warnings(action="ignore", category=SyntaxWarning):
                # The text after substitution is often `'arm' is not None`.
                code = compile(text.strip(), "expression", "eval")
            # As globals, because the scopes of comprehensions and lambdas see these only.
            return str(eval(code, names))
        except LaunchError:
            raise
        except SyntaxError as error:
            raise SubstitutionError(f"expression {text!r} is not Python: {error.msg}") from error
        except Exception as error:
            kind = type(error).__name__
            raise SubstitutionError(f"expression {text!r} raises {kind}: {error}") from error

    def describe(self) -> str:
        """Return the substitution as a launch file writes it."""
        return f"PythonExpression({describe_text(self.expression)!r})"
