"""Substitutions that find and run programs."""

from __future__ import annotations

from typing import TYPE_CHECKING, Literal

from launch_py.errors import NotFoundError, SubstitutionError
from launch_py.programs import find_program
from launch_py.substitution import Substitution, Text, describe_text, perform_text

if TYPE_CHECKING:
    from launch_py.launch_context import LaunchContext

OnStderr = Literal["fail", "ignore", "warn", "capture"]


class FindExecutable(Substitution):
    """The path of a program on PATH, or beside this Python."""

    def __init__(self, *, name: Text) -> None:
        self.name = name

    def perform(self, context: LaunchContext) -> str:
        """Return the path.

        Raises:
            NotFoundError: there is no such program.
        """
        return find_program(
            perform_text(context, self.name), context.environment_variable("PATH") or ""
        )

    def describe(self) -> str:
        """Return how it is written."""
        return f"FindExecutable({describe_text(self.name)!r})"


class Command(Substitution):
    """The output of a command, run while the launch file is expanded.

    The joined text is split as a shell does, without a shell. A Python process takes a quarter of
    a second: where the work is a Python function, `Call` does it in no time.
    """

    is_costly = True

    def __init__(self, command: Text, *, on_stderr: OnStderr = "fail") -> None:
        self.command = command
        self.on_stderr = on_stderr

    def perform(self, context: LaunchContext) -> str:
        """Return the standard output, without its last newline.

        Raises:
            SubstitutionError: the command failed, or wrote to stderr where that means failure.
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
            hint = "Command joins its parts as they are: is there a space missing, as in 'xacro '?"
            raise NotFoundError(f"{error}; {hint}") from error
        done = subprocess.run(
            words,
            capture_output=True,
            text=True,
            check=False,
            env=context.complete_environment(words[0]),
        )
        complaint = done.stderr.strip()
        if done.returncode != 0:
            raise SubstitutionError(
                f"command {text!r} ended with exit code {done.returncode}"
                + (f": {complaint}" if complaint else "")
            )
        if complaint and self.on_stderr == "fail":
            raise SubstitutionError(f"command {text!r} complained: {complaint}")
        if complaint and self.on_stderr == "warn":
            context.plan.warn(f"command {text!r} complained: {complaint}")
        output = done.stdout + (done.stderr if self.on_stderr == "capture" else "")
        return output.removesuffix("\n")

    def describe(self) -> str:
        """Return how it is written."""
        return f"Command({describe_text(self.command)!r})"
