"""Tab completion with argcomplete, and `arm completion`, which prints a shell's script.

An argument of a verb may have a completer, a function that returns the possible words. Completers
run only when a shell completes a line, so they may be slow: those of `arm_cli.ros.completers` look
at the running graph.
"""

import argparse
import os
import shlex
from collections.abc import Iterable, Sequence
from typing import Any

from arm_cli.arguments import Argument, verb
from arm_cli.output import say_document

SHELLS = ("bash", "zsh", "fish")


def complete_words() -> None:
    """Print the completions that the shell requests, and exit."""
    import argcomplete

    from arm_cli.verbs import ARM

    argcomplete.autocomplete(_parser(ARM), exclude=["-h", "--help"])


def interface_names(**_: Any) -> list[str]:
    """Return the installed types."""
    from arm_cli.interface_types import InterfaceIndex

    return [type_.full_name for type_ in InterfaceIndex().types()]


def message_names(**_: Any) -> list[str]:
    """Return the installed message types."""
    from arm_cli.interface_types import InterfaceIndex

    return [type_.full_name for type_ in InterfaceIndex().types(("msg",))]


def interface_packages(**_: Any) -> list[str]:
    """Return the packages that define types."""
    from arm_cli.interface_types import InterfaceIndex

    return InterfaceIndex().packages()


def words_before(first: int) -> list[str]:
    """Return the complete words typed so far, starting with word `first`; `arm` is word 0."""
    line = os.environ.get("COMP_LINE", "")
    typed = line[: int(os.environ.get("COMP_POINT") or len(line))]
    try:
        words = shlex.split(typed)
    except ValueError:
        # A quotation mark is open, so the last word is not complete.
        words = typed.split()
    return words[first:] if typed[-1:].isspace() else words[first:-1]


def _parser(family: Any) -> argparse.ArgumentParser:
    """Return a parser of the typed verb, for argcomplete.

    It has only the names of the other verbs, because importing them all would take too long.
    """
    parser = argparse.ArgumentParser(prog=family.name)
    _add_verbs(parser, family.verbs, words_before(1))
    return parser


def _add_verbs(parser: argparse.ArgumentParser, verbs: Iterable[Any], typed: Sequence[str]) -> None:
    from arm_cli.verb import VerbFamily

    choices = parser.add_subparsers()
    for entry in verbs:
        inner = choices.add_parser(entry.name, help=entry.help)
        if entry.name != next(iter(typed), None):
            continue
        if isinstance(entry, VerbFamily):
            _add_verbs(inner, entry.verbs, typed[1:])
            continue
        for argument in entry.arguments():
            argument.add_to(inner)


@verb(
    Argument("shell", choices=SHELLS),
    epilog="To install it, add 'eval \"$(arm completion bash)\"' to ~/.bashrc, the same with zsh "
    "to ~/.zshrc, or 'arm completion fish | source' to ~/.config/fish/config.fish.",
)
def completion(options: argparse.Namespace) -> None:
    """Print the script."""
    from argcomplete.shell_integration import shellcode

    # argcomplete has one script for both bash and zsh.
    shell = "fish" if options.shell == "fish" else "bash"
    say_document(shellcode(["arm"], shell=shell))
