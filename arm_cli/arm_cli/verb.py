"""Verbs and families of verbs.

A verb's module is imported only when the verb is used, so that `arm --help` and every verb start
fast.
"""

import argparse
import signal
import sys
from collections.abc import Callable, Sequence
from dataclasses import dataclass
from importlib import import_module
from typing import TYPE_CHECKING, Protocol, cast

from arm_cli.errors import ArmCliError

if TYPE_CHECKING:
    from arm_cli.command_parser import CommandParser

EXIT_USAGE = 2


class Runnable(Protocol):
    """What the table of verbs holds."""

    @property
    def name(self) -> str:
        """The word that stands for it."""
        ...

    @property
    def help(self) -> str:
        """One line that says what it does."""
        ...

    def run(self, program: str, words: Sequence[str]) -> int:
        """Carry it out; return the exit code.

        Args:
            program: what stood before `words`, such as "arm topic echo".
            words: the words after it.
        """
        ...


@dataclass(frozen=True, slots=True)
class Verb:
    """One verb, carried out by a module.

    The module defines `add_arguments(parser)` and `run(options) -> int | None`, whose result is
    the exit code, None for 0.
    """

    name: str
    help: str
    module: str

    def run(self, program: str, words: Sequence[str]) -> int:
        """Parse the words and carry the verb out; return the exit code."""
        options = self.parser(program).parse_words(words)
        run = cast("Callable[[argparse.Namespace], int | None]", import_module(self.module).run)
        return said_to_user(program, lambda: run(options))

    def parser(self, program: str) -> "CommandParser":
        """Return the verb's parser."""
        from arm_cli.command_parser import CommandParser

        parser = CommandParser(program, description=f"{self.help[0].upper()}{self.help[1:]}.")
        import_module(self.module).add_arguments(parser)
        return parser


@dataclass(frozen=True, slots=True)
class PlainVerb:
    """A verb that reads its words itself: its module defines `run(words) -> int`."""

    name: str
    help: str
    module: str

    def run(self, program: str, words: Sequence[str]) -> int:
        """Carry it out with the words after the verb; return the exit code."""
        run = cast("Callable[[Sequence[str]], int]", import_module(self.module).run)
        return said_to_user(program, lambda: run(words))


@dataclass(frozen=True, slots=True)
class VerbFamily:
    """Verbs that share a first word."""

    name: str
    help: str
    verbs: tuple[Runnable, ...]

    def run(self, program: str, words: Sequence[str]) -> int:
        """Carry out the verb that the first word names; return the exit code."""
        if not words or words[0] in ("-h", "--help", "help"):
            print(self.describe(program))
            return 0 if words else EXIT_USAGE
        verb = next((verb for verb in self.verbs if verb.name == words[0]), None)
        if verb is None:
            print(f"{program}: {self._unknown(words[0])}", file=sys.stderr)
            return EXIT_USAGE
        return verb.run(f"{program} {verb.name}", words[1:])

    def describe(self, program: str) -> str:
        """Return the help text: a line for each verb."""
        width = max(len(verb.name) for verb in self.verbs)
        return "\n".join(
            [
                f"usage: {program} [-h] VERB ...",
                "",
                f"{self.help[0].upper()}{self.help[1:]}.",
                "",
                "verbs:",
                *(f"  {verb.name:<{width}}  {verb.help}" for verb in self.verbs),
                "",
                f"`{program} VERB --help` explains a verb.",
            ]
        )

    def _unknown(self, word: str) -> str:
        from launch_py.near_names import describe_known

        what = "option" if word.startswith("-") else "verb"
        known = [verb.name for verb in self.verbs] if what == "verb" else ["--help", "--version"]
        return f"no {what} {word!r}; {describe_known(word, known)}"


def said_to_user(program: str, action: Callable[[], int | None]) -> int:
    """Return an action's exit code; what it raises for the user becomes one line on stderr.

    Raises:
        KeyboardInterrupt: Ctrl-C, whatever the interrupted code made of it.
    """
    # Only here: `arm --help` needs nothing of launch_py.
    from launch_py.interruption import Interruption

    interruption = Interruption()
    with interruption.at(signal.SIGINT):
        try:
            return action() or 0
        except Exception as error:
            if interruption.came:
                raise KeyboardInterrupt from error
            if not isinstance(error, ArmCliError):
                raise
            sys.stdout.flush()
            print(f"{program}: {error}", file=sys.stderr)
            return error.exit_code
