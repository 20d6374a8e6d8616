"""Substitutions that find packages, named as in ROS 2's `launch_ros.substitutions`."""

from __future__ import annotations

from launch_py.substitution import LaunchScope, Substitution, Text, describe_text, perform_text
from launch_py.system.packages import Packages


class FindPackageShare(Substitution):
    """The share folder of a package."""

    def __init__(self, package: Text) -> None:
        self.package = package

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


class FindPackagePrefix(FindPackageShare):
    """The prefix in which a package is installed."""

    def perform(self, context: LaunchScope) -> str:
        """Return the path.

        Raises:
            NotFoundError: there is no such package.
        """
        return str(Packages(context.base_environment).prefix(perform_text(context, self.package)))
