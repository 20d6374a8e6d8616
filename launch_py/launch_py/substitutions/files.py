"""Substitutions for paths, files and names that this launch makes up."""

from __future__ import annotations

import os
import stat
from collections.abc import Iterable

from launch_py.errors import SubstitutionError
from launch_py.near_names import describe_irregular_file
from launch_py.substitution import LaunchScope, Substitution, Text, describe_text, perform_text
from launch_py.system.child_environment import launch_name, log_root

MAX_CHARACTERS = 20_000_000
"""Maximum length of a file whose text a launch file takes; robots' descriptions are shorter."""


class PathJoinSubstitution(Substitution):
    """A path joined from its parts; `path / part` adds another one."""

    def __init__(self, substitutions: Iterable[Text]) -> None:
        self.parts = tuple(substitutions)

    def perform(self, context: LaunchScope) -> str:
        """Return the joined path."""
        return os.path.join(*(perform_text(context, part) for part in self.parts))

    def describe(self) -> str:
        """Return the substitution as a launch file writes it."""
        return "/".join(describe_text(part) for part in self.parts)

    def __truediv__(self, part: Text) -> PathJoinSubstitution:
        return PathJoinSubstitution([self, part])


class PathSubstitution(PathJoinSubstitution):
    """One path, to which `/` adds parts."""

    def __init__(self, path: Text) -> None:
        super().__init__([path])


class LaunchLogDir(PathSubstitution):
    """The folder of this launch's log files."""

    def __init__(self) -> None:
        super().__init__("the log folder")

    def perform(self, context: LaunchScope) -> str:
        """Return the path, which exists once the first process starts."""
        return str(log_root(context.base_environment) / launch_name())


class ThisLaunchFile(Substitution):
    """The path of the launch file that is being expanded."""

    def perform(self, context: LaunchScope) -> str:
        """Return the path."""
        if context.launch_file is None:
            raise SubstitutionError("ThisLaunchFile has no value: no launch file is being read")
        return str(context.launch_file)


class ThisLaunchFileDir(PathSubstitution):
    """The folder of the launch file that is being expanded."""

    def __init__(self) -> None:
        super().__init__("the launch file's folder")

    def perform(self, context: LaunchScope) -> str:
        """Return the path of the folder."""
        return os.path.dirname(ThisLaunchFile().perform(context))


class FileContent(Substitution):
    """The text of a file."""

    def __init__(self, path: Text) -> None:
        self.path = path

    def perform(self, context: LaunchScope) -> str:
        """Return the text.

        Raises:
            SubstitutionError: the file cannot be read, is a device or a FIFO (which might never
                end), is too long, or is not UTF-8.
        """
        path = perform_text(context, self.path)
        try:
            if not stat.S_ISREG(os.stat(path).st_mode):
                raise SubstitutionError(describe_irregular_file("text file", path))
            with open(path, encoding="utf-8") as file:
                text = file.read(MAX_CHARACTERS + 1)
        except (OSError, ValueError) as error:  # ValueError: not UTF-8, or a null in the path.
            why = getattr(error, "strerror", None) or str(error)
            raise SubstitutionError(f"cannot read {path}: {why}") from error
        if len(text) > MAX_CHARACTERS:
            raise SubstitutionError(f"{path} has more than {MAX_CHARACTERS} characters")
        return text

    def describe(self) -> str:
        """Return the substitution as a launch file writes it."""
        return f"FileContent({describe_text(self.path)!r})"


class AnonName(Substitution):
    """A name that no other launch uses; the same name gives the same one in this launch."""

    def __init__(self, name: Text) -> None:
        self.name = name

    def perform(self, context: LaunchScope) -> str:
        """Return the name with a suffix."""
        name = perform_text(context, self.name)
        if name not in context.anonymous_names:
            import secrets

            context.anonymous_names[name] = f"{name}_{os.getpid()}_{secrets.randbits(63)}"
        return context.anonymous_names[name]

    def describe(self) -> str:
        """Return the substitution as a launch file writes it."""
        return f"AnonName({describe_text(self.name)!r})"
