"""`arm interface packages`: the packages that define types."""

import argparse

from arm_cli.interface.list import add_kind_arguments, wanted_kinds
from arm_cli.interfaces.index import InterfaceIndex
from arm_cli.output import add_json_argument, print_json


def add_arguments(parser: argparse.ArgumentParser) -> None:
    """Add the verb's arguments."""
    add_kind_arguments(parser)
    add_json_argument(parser)


def run(options: argparse.Namespace) -> None:
    """Print the names of the packages."""
    names = InterfaceIndex().packages(wanted_kinds(options))
    if options.json:
        print_json(names)
    else:
        print(*names, sep="\n", end="\n" if names else "")
