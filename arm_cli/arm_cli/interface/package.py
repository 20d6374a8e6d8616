"""`arm interface package`: the types of one package."""

import argparse

from arm_cli.errors import NotFoundError
from arm_cli.interface.list import add_kind_arguments, wanted_kinds
from arm_cli.interfaces.index import InterfaceIndex
from arm_cli.output import add_json_argument, print_json
from arm_cli.word_completion import complete_with, interface_packages
from launch_py.near_names import describe_known


def add_arguments(parser: argparse.ArgumentParser) -> None:
    """Add the verb's arguments."""
    complete_with(
        parser.add_argument("package_name", help="such as std_msgs"),
        interface_packages,
    )
    add_kind_arguments(parser)
    add_json_argument(parser)


def run(options: argparse.Namespace) -> None:
    """Print the names of the types.

    Raises:
        NotFoundError: no such package, or one without types.
    """
    index = InterfaceIndex()
    package = options.package_name
    packages = index.packages()
    if package not in packages:
        known = describe_known(package, packages)
        raise NotFoundError(f"no package with interfaces {package!r}; {known}")
    names = [type_.full_name for type_ in index.types(wanted_kinds(options), package)]
    if options.json:
        print_json(names)
    else:
        print(*names, sep="\n", end="\n" if names else "")
