"""`arm pkg prefix`: where a package is installed."""

import argparse
import os
from typing import Any

from arm_cli.errors import NotFoundError
from arm_cli.word_completion import complete_with
from launch_py.errors import LaunchError
from launch_py.packages import Packages


def add_arguments(parser: argparse.ArgumentParser) -> None:
    """Add the verb's arguments."""
    complete_with(
        parser.add_argument("package_name", help="such as arm_description"), package_names
    )
    parser.add_argument("--share", action="store_true", help="its share folder instead")


def run(options: argparse.Namespace) -> None:
    """Print the folder.

    Raises:
        NotFoundError: there is no such package; the message names near ones.
    """
    packages = Packages(os.environ)
    find = packages.share_folder if options.share else packages.prefix
    try:
        print(find(options.package_name))
    except LaunchError as error:
        raise NotFoundError(str(error)) from error


def package_names(**_: Any) -> list[str]:
    """Return the packages, for the Tab key."""
    return Packages(os.environ).names()
