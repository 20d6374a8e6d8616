"""`arm pkg executables`: what `arm run` can run."""

import argparse
import os
import sysconfig
from pathlib import Path

from arm_cli.errors import NotFoundError
from arm_cli.output import add_json_argument, print_json
from arm_cli.run_verb import packages as packages_with_executables
from arm_cli.word_completion import complete_with
from launch_py.near_names import describe_known
from launch_py.packages import Packages


def add_arguments(parser: argparse.ArgumentParser) -> None:
    """Add the verb's arguments."""
    complete_with(
        parser.add_argument("package_name", nargs="?", help="by default every package"),
        packages_with_executables,
    )
    parser.add_argument("--full-path", action="store_true", help="the files themselves")
    add_json_argument(parser)


def run(options: argparse.Namespace) -> None:
    """Print package and name of each executable.

    Raises:
        NotFoundError: there is no such package; the message names near ones.
    """
    packages = Packages(os.environ)
    found = packages.executables()
    wanted = options.package_name
    if wanted is not None:
        known = {*packages.names(), *(package for package, _ in found)}
        if wanted not in known:
            raise NotFoundError(f"no package {wanted!r}; {describe_known(wanted, known)}")
        found = [(package, name) for package, name in found if package == wanted]
    if options.json:
        print_json([{"package": package, "executable": name} for package, name in found])
        return
    for package, name in found:
        print(_path(packages, package, name) if options.full_path else f"{package} {name}")


def _path(packages: Packages, package: str, name: str) -> Path:
    command = packages.executable(package, name)
    # A script of a Python distribution is run by its function; its file is where pip puts scripts.
    return Path(command[0]) if len(command) == 1 else Path(sysconfig.get_path("scripts"), name)
