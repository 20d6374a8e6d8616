"""Substitutions that find packages, named as in ROS 2's `launch_ros.substitutions`."""

from __future__ import annotations

from launch_py.errors import NotFoundError, SubstitutionError
from launch_py.near_names import describe_known
from launch_py.substitution import LaunchScope, Substitution, Text, describe_text, perform_text
from launch_py.substitutions.files import PathSubstitution
from launch_py.system.packages import Packages


class FindPackage(PathSubstitution):
    """A folder of a package; `/` adds parts to its path."""

    def __init__(self, package: Text) -> None:
        super().__init__(package)
        self.package = package


class FindPackageShare(FindPackage):
    """The share folder of a package."""

    def perform(self, context: LaunchScope) -> str:
        """Return the path.

        Raises:
            NotFoundError: there is no such package.
        """
        packages = Packages(context.base_environment)
        return str(packages.share_folder(perform_text(context, self.package)))

    def describe(self) -> str:
        """Return the substitution as messages show it."""
        return f"FindPackageShare({describe_text(self.package)!r})"


class FindPackagePrefix(FindPackage):
    """The prefix in which a package is installed."""

    def perform(self, context: LaunchScope) -> str:
        """Return the path.

        Raises:
            NotFoundError: there is no such package.
        """
        return str(Packages(context.base_environment).prefix(perform_text(context, self.package)))

    def describe(self) -> str:
        """Return the substitution as messages show it."""
        return f"FindPackagePrefix({describe_text(self.package)!r})"


class ExecutableInPackage(FindPackagePrefix):
    """The path of an executable in a package's lib folder."""

    def __init__(self, executable: Text, package: Text) -> None:
        super().__init__(package)
        self.executable = executable

    def perform(self, context: LaunchScope) -> str:
        """Return the path.

        Raises:
            NotFoundError: there is no such package or executable, or it is not one file.
        """
        name = perform_text(context, self.executable)
        package = perform_text(context, self.package)
        path = Packages(context.base_environment).executable_file(package, name)
        if path is None:
            raise NotFoundError(f"package {package!r} has no file of its executable {name!r}")
        return path

    def describe(self) -> str:
        """Return the substitution as messages show it."""
        return f"ExecutableInPackage({describe_text(self.executable)!r})"


class ParameterSubstitution(Substitution):
    """The value that `SetParameter` has given a parameter in this scope."""

    def __init__(self, name: Text, *, default: Text | None = None) -> None:
        self.name = name
        self.default = default

    def perform(self, context: LaunchScope) -> str:
        """Return the value, else the default."""
        name = perform_text(context, self.name)
        known = {key: v for p in context.parameters if isinstance(p, dict) for key, v in p.items()}
        if name in known:
            return str(known[name])
        if self.default is not None:
            return perform_text(context, self.default)
        hint = describe_known(name, known, "set so far:")
        raise SubstitutionError(f"no SetParameter sets {name!r} before its use; {hint}")

    def describe(self) -> str:
        """Return the substitution as messages show it."""
        return f"Parameter({describe_text(self.name)!r})"


Parameter = ParameterSubstitution
"""ROS's name, which the description of a parameter has, too."""
