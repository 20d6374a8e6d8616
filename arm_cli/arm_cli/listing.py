"""Names with their types: what `list` and `find` of topics, services and actions have in common."""

import argparse
from collections.abc import Callable, Mapping, Sequence
from typing import TYPE_CHECKING

from arm_cli.interfaces.index import InterfaceIndex
from arm_cli.output import add_json_argument, print_json
from arm_cli.ros.connection import connect

if TYPE_CHECKING:
    from arm_cli.ros.graph import Graph


def add_list_arguments(parser: argparse.ArgumentParser, kind: str) -> None:
    """Add how a list is shown; `kind` is what is listed, such as "topics"."""
    parser.add_argument("-t", "--show-types", action="store_true", help="with their types")
    add_count_argument(parser, kind)
    add_json_argument(parser)


def add_count_argument(parser: argparse.ArgumentParser, kind: str) -> None:
    """Add `-c`."""
    parser.add_argument(
        "-c", f"--count-{kind}", dest="count", action="store_true", help="only their number"
    )


def add_hidden_argument(parser: argparse.ArgumentParser, kind: str, *flags: str) -> None:
    """Add `-a`, by these flags beside its usual long one."""
    parser.add_argument(
        "-a",
        *flags,
        f"--include-hidden-{kind}",
        dest="hidden",
        action="store_true",
        help=f"hidden {kind}, too",
    )


def print_list(found: Mapping[str, Sequence[str]], options: argparse.Namespace) -> None:
    """Print the names, as the arguments of `add_list_arguments` have it.

    Args:
        found: the types of each name.
        options: as parsed.
    """
    if options.json:
        print_json([{"name": name, "types": types} for name, types in found.items()])
    elif options.count:
        print(len(found))
    else:
        for name, types in found.items():
            print(f"{name} [{', '.join(types)}]" if options.show_types else name)


def print_those_of(
    type_name: str,
    kind: str,
    names_of: Callable[["Graph"], Mapping[str, Sequence[str]]],
    options: argparse.Namespace,
) -> None:
    """Print the names of one type, or by `add_count_argument` only their number.

    Args:
        type_name: as the user wrote it, with or without its middle part.
        kind: of the type: "msg", "srv" or "action".
        names_of: looks up names with their types.
        options: as parsed.

    Raises:
        NotFoundError: there is no such type.
    """
    wanted = InterfaceIndex().find(type_name, (kind,)).full_name
    with connect() as session:
        from arm_cli.ros.graph import Graph

        graph = Graph(session)
        graph.settle()
        found = names_of(graph)
    names = [name for name, types in found.items() if wanted in types]
    if options.count:
        print(len(names))
    else:
        print(*names, sep="\n", end="\n" if names else "")
