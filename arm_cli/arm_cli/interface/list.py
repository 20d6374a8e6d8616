"""`arm interface list`: the installed types."""

import argparse

from arm_cli.interfaces.index import KINDS, InterfaceIndex
from arm_cli.output import add_json_argument, print_json

TITLES = {"msg": "Messages", "srv": "Services", "action": "Actions"}


def add_arguments(parser: argparse.ArgumentParser) -> None:
    """Add the verb's arguments."""
    add_kind_arguments(parser)
    add_json_argument(parser)


def run(options: argparse.Namespace) -> None:
    """Print the names of the types, by kind."""
    index = InterfaceIndex()
    names = {kind: [t.full_name for t in index.types((kind,))] for kind in wanted_kinds(options)}
    if options.json:
        print_json(names)
        return
    for kind, full_names in names.items():
        print(f"{TITLES[kind]}:")
        for name in full_names:
            print(f"    {name}")


def add_kind_arguments(parser: argparse.ArgumentParser) -> None:
    """Add the options that restrict a list to some kinds."""
    parser.add_argument("-m", "--only-msgs", action="store_true", help="only message types")
    parser.add_argument("-s", "--only-srvs", action="store_true", help="only service types")
    parser.add_argument("-a", "--only-actions", action="store_true", help="only action types")


def wanted_kinds(options: argparse.Namespace) -> tuple[str, ...]:
    """Return the kinds that were asked for; all without a choice."""
    chosen = dict(
        zip(KINDS, (options.only_msgs, options.only_srvs, options.only_actions), strict=True)
    )
    return tuple(kind for kind in KINDS if chosen[kind]) or KINDS
