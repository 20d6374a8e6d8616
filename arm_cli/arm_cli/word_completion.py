"""What the Tab key offers, by argcomplete.

A verb's argument is given a completer, a function that returns the words that fit. Completers are
asked only while a shell completes, so they may be slow: those of `arm_cli.ros.completers` look at
the running graph.
"""

import argparse
from collections.abc import Callable, Iterable
from typing import Any

Completer = Callable[..., Iterable[str]]


def complete_with(argument: argparse.Action, completer: Completer) -> None:
    """Let Tab offer a completer's words for an argument."""
    argument.completer = completer  # pyright: ignore[reportAttributeAccessIssue]


def complete_words() -> None:
    """Answer the shell that asks for completions, and end the process."""
    import argcomplete

    from arm_cli.verbs import ARM

    argcomplete.autocomplete(_parser(ARM), exclude=["-h", "--help"])


def interface_names(**_: Any) -> list[str]:
    """Return the installed types."""
    from arm_cli.interfaces.index import InterfaceIndex

    return [type_.full_name for type_ in InterfaceIndex().types()]


def message_names(**_: Any) -> list[str]:
    """Return the installed message types."""
    from arm_cli.interfaces.index import InterfaceIndex

    return [type_.full_name for type_ in InterfaceIndex().types(("msg",))]


def interface_packages(**_: Any) -> list[str]:
    """Return the packages that define types."""
    from arm_cli.interfaces.index import InterfaceIndex

    return InterfaceIndex().packages()


def _parser(family: Any) -> argparse.ArgumentParser:
    """Return one parser of everything: the form in which argcomplete wants it."""
    parser = argparse.ArgumentParser(prog=family.name)
    _add_verbs(parser, family.verbs)
    return parser


def _add_verbs(parser: argparse.ArgumentParser, verbs: Iterable[Any]) -> None:
    from importlib import import_module

    from arm_cli.verb import VerbFamily

    choices = parser.add_subparsers()
    for verb in verbs:
        inner = choices.add_parser(verb.name, help=verb.help)
        if isinstance(verb, VerbFamily):
            _add_verbs(inner, verb.verbs)
            continue
        add_arguments = getattr(import_module(verb.module), "add_arguments", None)
        if add_arguments is not None:
            add_arguments(inner)
