"""`arm pkg`: packages, where they are, their executables and manifests."""

import argparse
import os
import sysconfig
from pathlib import Path
from typing import Any

from arm_cli.arguments import JSON, Argument, Flag, verb
from arm_cli.errors import NoSuchNameError
from arm_cli.output import say, say_answer, say_document
from arm_cli.run import packages as packages_with_executables
from arm_node.names import describe_known
from arm_node.user_file import read_text
from launch_py.errors import LaunchError
from launch_py.system.packages import Packages

MANIFEST = "package.xml"


def package_names(**_: Any) -> list[str]:
    """Return the packages, for the Tab key."""
    return Packages(os.environ).names()


@verb(JSON)
def list_packages(options: argparse.Namespace) -> None:
    """Print the names of the packages."""
    names = Packages(os.environ).names()
    say_answer(options, names, names)


@verb(
    Argument("package_name", help="such as arm_description", completer=package_names),
    Flag("--share", help="print its share folder instead"),
)
def prefix(options: argparse.Namespace) -> None:
    """Print the folder."""
    packages = Packages(os.environ)
    find = packages.share_folder if options.share else packages.prefix
    try:
        say(find(options.package_name))
    except LaunchError as error:
        raise NoSuchNameError(str(error)) from error


@verb(
    Argument(
        "package_name",
        nargs="?",
        help="default: every package",
        completer=packages_with_executables,
    ),
    Flag("--full-path", help="print the paths of the files"),
    JSON,
)
def executables(options: argparse.Namespace) -> None:
    """Print package and name of each executable."""
    packages = Packages(os.environ)
    found = packages.executables()
    wanted = options.package_name
    if wanted is not None:
        known = {*packages.names(), *(package for package, _ in found)}
        if wanted not in known:
            raise NoSuchNameError(f"no package {wanted!r}; {describe_known(wanted, known)}")
        found = [(package, name) for package, name in found if package == wanted]
    rows = [{"package": package, "executable": name} for package, name in found]
    lines = (_path(packages, *each) if options.full_path else " ".join(each) for each in found)
    say_answer(options, rows, lines)


def _path(packages: Packages, package: str, name: str) -> Path:
    stand_in = packages.stand_in_of(package, name)
    if stand_in is not None:
        package, name, *_ = stand_in.words
    command = packages.executable(package, name)
    # The command of a Python distribution's script calls its function; pip puts its file there.
    return Path(command[0]) if len(command) == 1 else Path(sysconfig.get_path("scripts"), name)


@verb(
    Argument("package_name", help="such as arm_description", completer=package_names),
    Argument("-t", "--tag", help="print only the text of this element, such as version"),
)
def xml(options: argparse.Namespace) -> None:
    """Print the manifest, or one of its elements."""
    try:
        path = Packages(os.environ).share_folder(options.package_name) / MANIFEST
    except LaunchError as error:
        raise NoSuchNameError(str(error)) from error
    try:
        text = read_text(path)
    except OSError as error:
        raise NoSuchNameError(f"no manifest {path}: {error.strerror}") from error
    if options.tag is None:
        say_document(text, end="")
        return
    import xml.etree.ElementTree as ET

    try:
        elements = list(ET.fromstring(text))
    except ET.ParseError as error:
        raise NoSuchNameError(f"{path} is not XML: {error}") from error
    found = [element.text or "" for element in elements if element.tag == options.tag]
    if not found:
        hint = describe_known(options.tag, (element.tag for element in elements), "it has")
        raise NoSuchNameError(f"{path} has no element {options.tag!r}; {hint}")
    say_document("\n".join(found))
