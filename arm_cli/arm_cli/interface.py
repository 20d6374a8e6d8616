"""`arm interface`: the installed types, their packages, definitions and fields."""

import argparse
import sys

from arm_cli.arguments import JSON, Argument, Exclusive, Flag, verb
from arm_cli.errors import CommandUsageError, NoSuchNameError
from arm_cli.interface_types import KINDS, Comments, InterfaceIndex, describe_type, load_class
from arm_cli.output import print_json, say, say_answer, say_document
from arm_cli.word_completion import interface_names, interface_packages
from arm_node.names import describe_known

TITLES = {"msg": "Messages", "srv": "Services", "action": "Actions"}
ONLY = (
    Flag("-m", "--only-msgs", help="only message types"),
    Flag("-s", "--only-srvs", help="only service types"),
    Flag("-a", "--only-actions", help="only action types"),
)
"""The options that restrict a list to some kinds of types."""


@verb(*ONLY, JSON)
def list_types(options: argparse.Namespace) -> None:
    """Print the names of the types, by kind."""
    index = InterfaceIndex()
    names = {kind: [t.full_name for t in index.types((kind,))] for kind in wanted_kinds(options)}
    if options.json:
        print_json(names)
        return
    for kind, full_names in names.items():
        say(f"{TITLES[kind]}:")
        for name in full_names:
            say(f"    {name}")


def wanted_kinds(options: argparse.Namespace) -> tuple[str, ...]:
    """Return the requested kinds; without a request all kinds."""
    chosen = dict(
        zip(KINDS, (options.only_msgs, options.only_srvs, options.only_actions), strict=True)
    )
    return tuple(kind for kind in KINDS if chosen[kind]) or KINDS


@verb(Argument("package_name", help="such as std_msgs", completer=interface_packages), *ONLY, JSON)
def package(options: argparse.Namespace) -> None:
    """Print the names of the types."""
    index = InterfaceIndex()
    package = options.package_name
    packages = index.packages()
    if package not in packages:
        known = describe_known(package, packages)
        raise NoSuchNameError(f"no interface package {package!r}; {known}")
    names = [type_.full_name for type_ in index.types(wanted_kinds(options), package)]
    say_answer(options, names, names)


@verb(*ONLY, JSON)
def packages(options: argparse.Namespace) -> None:
    """Print the names of the packages."""
    names = InterfaceIndex().packages(wanted_kinds(options))
    say_answer(options, names, names)


@verb(
    Argument("type", help="such as std_msgs/msg/String; - for stdin", completer=interface_names),
    Exclusive(
        Flag("--all-comments", help="also show the comments of nested types"),
        Flag("--no-comments", help="show neither comments nor empty lines"),
    ),
)
def show(options: argparse.Namespace) -> None:
    """Print the definition."""
    name = sys.stdin.readline().strip() if options.type == "-" else options.type
    if not name:
        raise CommandUsageError("stdin does not hold the name of a type")
    index = InterfaceIndex()
    comments = Comments(outer=not options.no_comments, nested=options.all_comments)
    for line in describe_type(index, index.find(name), comments):
        say(line)


@verb(
    Argument("type", help="such as std_msgs/msg/String", completer=interface_names),
    Flag("--no-quotes", help="print no quotes around the text"),
)
def proto(options: argparse.Namespace) -> None:
    """Print the type's fields (a service's request, an action's goal) with their default values."""
    type_ = InterfaceIndex().find(options.type)
    from arm_node.messages.text import to_yaml

    class_ = load_class(type_)
    part = {"msg": class_, "srv": getattr(class_, "Request", None), "action": None}[type_.kind]
    text = to_yaml((part or class_.Goal)())
    say_document(text if options.no_quotes else f'"{text}"')
