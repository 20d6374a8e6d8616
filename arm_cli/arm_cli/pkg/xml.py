"""`arm pkg xml`: a package's manifest."""

import argparse
import os

from arm_cli.errors import NotFoundError
from arm_cli.pkg.prefix import package_names
from arm_cli.word_completion import complete_with
from launch_py.errors import LaunchError
from launch_py.near_names import describe_known
from launch_py.packages import Packages

MANIFEST = "package.xml"


def add_arguments(parser: argparse.ArgumentParser) -> None:
    """Add the verb's arguments."""
    complete_with(
        parser.add_argument("package_name", help="such as arm_description"), package_names
    )
    parser.add_argument("-t", "--tag", help="only what this element says, such as version")


def run(options: argparse.Namespace) -> None:
    """Print the manifest, or one of its elements.

    Raises:
        NotFoundError: there is no such package, manifest or element.
    """
    try:
        path = Packages(os.environ).share_folder(options.package_name) / MANIFEST
    except LaunchError as error:
        raise NotFoundError(str(error)) from error
    try:
        text = path.read_text(encoding="utf-8")
    except OSError as error:
        raise NotFoundError(f"no manifest {path}: {error.strerror}") from error
    if options.tag is None:
        print(text, end="")
        return
    import xml.etree.ElementTree as ET

    try:
        elements = list(ET.fromstring(text))
    except ET.ParseError as error:
        raise NotFoundError(f"{path} is no XML: {error}") from error
    found = [element.text or "" for element in elements if element.tag == options.tag]
    if not found:
        hint = describe_known(options.tag, (element.tag for element in elements), "it has")
        raise NotFoundError(f"{path} has no element {options.tag!r}; {hint}")
    print(*found, sep="\n")
