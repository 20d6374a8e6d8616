"""`arm interface`: the installed types, their packages, definitions and fields."""

import argparse
import sys

from arm_cli.errors import CommandUsageError, NoSuchNameError
from arm_cli.interfaces.definition import Comments, describe_type
from arm_cli.interfaces.index import KINDS, InterfaceIndex, load_class
from arm_cli.output import add_json_argument, print_json, say, say_document
from arm_cli.verb import VerbFunctions
from arm_cli.word_completion import complete_with, interface_names, interface_packages
from arm_node.names import describe_known

TITLES = {"msg": "Messages", "srv": "Services", "action": "Actions"}


def add_list_types_arguments(parser: argparse.ArgumentParser) -> None:
    """Add the verb's arguments."""
    add_kind_arguments(parser)
    add_json_argument(parser)


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


def add_kind_arguments(parser: argparse.ArgumentParser) -> None:
    """Add the options that restrict a list to some kinds of types."""
    parser.add_argument("-m", "--only-msgs", action="store_true", help="only message types")
    parser.add_argument("-s", "--only-srvs", action="store_true", help="only service types")
    parser.add_argument("-a", "--only-actions", action="store_true", help="only action types")


def wanted_kinds(options: argparse.Namespace) -> tuple[str, ...]:
    """Return the requested kinds; without a request all kinds."""
    chosen = dict(
        zip(KINDS, (options.only_msgs, options.only_srvs, options.only_actions), strict=True)
    )
    return tuple(kind for kind in KINDS if chosen[kind]) or KINDS


def add_list_package_arguments(parser: argparse.ArgumentParser) -> None:
    """Add the verb's arguments."""
    complete_with(
        parser.add_argument("package_name", help="such as std_msgs"),
        interface_packages,
    )
    add_kind_arguments(parser)
    add_json_argument(parser)


def list_package(options: argparse.Namespace) -> None:
    """Print the names of the types.

    Raises:
        NoSuchNameError: there is no such package, or it has no types.
    """
    index = InterfaceIndex()
    package = options.package_name
    packages = index.packages()
    if package not in packages:
        known = describe_known(package, packages)
        raise NoSuchNameError(f"no interface package {package!r}; {known}")
    names = [type_.full_name for type_ in index.types(wanted_kinds(options), package)]
    if options.json:
        print_json(names)
    else:
        say(*names)


def add_list_packages_arguments(parser: argparse.ArgumentParser) -> None:
    """Add the verb's arguments."""
    add_kind_arguments(parser)
    add_json_argument(parser)


def list_packages(options: argparse.Namespace) -> None:
    """Print the names of the packages."""
    names = InterfaceIndex().packages(wanted_kinds(options))
    if options.json:
        print_json(names)
    else:
        say(*names)


def add_show_arguments(parser: argparse.ArgumentParser) -> None:
    """Add the verb's arguments."""
    complete_with(
        parser.add_argument("type", help="such as std_msgs/msg/String; - for stdin"),
        interface_names,
    )
    group = parser.add_mutually_exclusive_group()
    group.add_argument(
        "--all-comments", action="store_true", help="also show the comments of nested types"
    )
    group.add_argument(
        "--no-comments", action="store_true", help="show neither comments nor empty lines"
    )


def show(options: argparse.Namespace) -> None:
    """Print the definition.

    Raises:
        NoSuchNameError: there is no such type.
        CommandUsageError: stdin does not hold a name.
    """
    name = sys.stdin.readline().strip() if options.type == "-" else options.type
    if not name:
        raise CommandUsageError("stdin does not hold the name of a type")
    index = InterfaceIndex()
    comments = Comments(outer=not options.no_comments, nested=options.all_comments)
    for line in describe_type(index, index.find(name), comments):
        say(line)


def add_print_prototype_arguments(parser: argparse.ArgumentParser) -> None:
    """Add the verb's arguments."""
    complete_with(
        parser.add_argument("type", help="such as std_msgs/msg/String"),
        interface_names,
    )
    parser.add_argument("--no-quotes", action="store_true", help="print no quotes around the text")


def print_prototype(options: argparse.Namespace) -> None:
    """Print the type's fields (a service's request, an action's goal) with their default values.

    Raises:
        NoSuchNameError: there is no such type.
    """
    type_ = InterfaceIndex().find(options.type)
    from arm_cli.messages.text import to_yaml

    class_ = load_class(type_)
    part = {"msg": class_, "srv": getattr(class_, "Request", None), "action": None}[type_.kind]
    text = to_yaml((part or class_.Goal)())
    say_document(text if options.no_quotes else f'"{text}"')


LIST_TYPES = VerbFunctions(add_list_types_arguments, list_types)
LIST_PACKAGE = VerbFunctions(add_list_package_arguments, list_package)
LIST_PACKAGES = VerbFunctions(add_list_packages_arguments, list_packages)
SHOW = VerbFunctions(add_show_arguments, show)
PRINT_PROTOTYPE = VerbFunctions(add_print_prototype_arguments, print_prototype)
