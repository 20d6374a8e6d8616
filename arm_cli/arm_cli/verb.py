"""Verbs and families of verbs.

The module of a verb is imported only when the verb is used. So `arm --help` and every verb start
fast.
"""

import argparse
import signal
from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass, field
from importlib import import_module
from typing import TYPE_CHECKING, Any, Protocol, cast

from arm_cli.errors import ArmCliError
from arm_cli.output import complain, say_document

if TYPE_CHECKING:
    from arm_cli.command_parser import CommandParser

EXIT_USAGE = 2


class Runnable(Protocol):
    """An entry in the table of verbs: a verb or a family of verbs."""

    @property
    def name(self) -> str:
        """The word on the command line."""
        ...

    @property
    def help(self) -> str:
        """One line of help."""
        ...

    def run(self, program: str, words: Sequence[str]) -> int:
        """Run it; return the exit code.

        Args:
            program: the words before `words`, such as "arm topic echo".
            words: the words after its name.
        """
        ...


class _VerbImplementation(Protocol):
    """Implements a verb: a module, or a `VerbFunctions` in a module with several verbs."""

    @property
    def add_arguments(self) -> Callable[[argparse.ArgumentParser], None]:
        """Declares the arguments."""
        ...

    @property
    def run(self) -> Callable[[argparse.Namespace], int | None]:
        """Runs the verb; its result is the exit code, None for 0."""
        ...


@dataclass(frozen=True, slots=True)
class VerbFunctions:
    """The two functions of one verb, in a module that has several verbs."""

    add_arguments: Callable[[argparse.ArgumentParser], None]
    run: Callable[[argparse.Namespace], int | None]


@dataclass(frozen=True, slots=True)
class Verb:
    """One verb.

    Attributes:
        name: the word on the command line.
        help: one line of help.
        where: a module with `add_arguments(parser)` and `run(options) -> int | None`, whose result
            is the exit code, None for 0; or "module:NAME" for a `VerbFunctions` in a module.
    """

    name: str
    help: str
    where: str

    def run(self, program: str, words: Sequence[str]) -> int:
        """Parse the words and run the verb; return the exit code."""
        options = self.parser(program).parse_words(words)
        run = self.load().run
        return run_reporting_errors(program, lambda: run(options))

    def load(self) -> _VerbImplementation:
        """Import and return the verb's implementation."""
        module, _, name = self.where.partition(":")
        found: Any = import_module(module)
        return getattr(found, name) if name else found

    def parser(self, program: str) -> "CommandParser":
        """Return the verb's parser."""
        from arm_cli.command_parser import CommandParser

        parser = CommandParser(program, description=f"{self.help[0].upper()}{self.help[1:]}.")
        self.load().add_arguments(parser)
        return parser


@dataclass(frozen=True, slots=True)
class PlainVerb:
    """A verb that parses its words itself: its module defines `run(words) -> int`."""

    name: str
    help: str
    module: str

    def run(self, program: str, words: Sequence[str]) -> int:
        """Run it with the words after the verb; return the exit code."""
        run = cast("Callable[[Sequence[str]], int]", import_module(self.module).run)
        return run_reporting_errors(program, lambda: run(words))


@dataclass(frozen=True, slots=True)
class VerbFamily:
    """Verbs that share a first word."""

    name: str
    help: str
    verbs: tuple[Runnable, ...]
    missing: Mapping[str, str] = field(default_factory=dict[str, str])
    """Verbs of ros2 that do not exist here, each with a sentence that says why."""

    def run(self, program: str, words: Sequence[str]) -> int:
        """Run the verb that the first word names; return the exit code."""
        if not words or words[0] in ("-h", "--help", "help"):
            say_document(self.describe(program))
            return 0 if words else EXIT_USAGE
        verb = next((verb for verb in self.verbs if verb.name == words[0]), None)
        if verb is None:
            complain(f"{program}: {self._unknown(words[0])}")
            return EXIT_USAGE
        return verb.run(f"{program} {verb.name}", words[1:])

    def describe(self, program: str) -> str:
        """Return the help text, with a line for each verb."""
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
        from arm_node.names import describe_known

        if word in self.missing:
            return f"no verb {word!r}: {self.missing[word]}"
        what = "option" if word.startswith("-") else "verb"
        known = [verb.name for verb in self.verbs] if what == "verb" else ["--help", "--version"]
        return f"no {what} {word!r}; {describe_known(word, known)}"


def run_reporting_errors(program: str, action: Callable[[], int | None]) -> int:
    """Run an action; return its exit code. An error for the user becomes one line on stderr.

    Raises:
        KeyboardInterrupt: Ctrl-C was pressed, even if the interrupted code raised another error.
    """
    # Imported here, because `arm --help` does not need launch_py.
    from launch_py.command.interruption import Interruption

    interruption = Interruption()
    with interruption.at(signal.SIGINT):
        try:
            return action() or 0
        except Exception as error:
            # Some libraries turn Ctrl-C into an error of their own; other errors are raised again.
            if interruption.came:
                raise KeyboardInterrupt from error
            if not isinstance(error, ArmCliError):
                raise
            complain(f"{program}: {error}")
            return error.exit_code
