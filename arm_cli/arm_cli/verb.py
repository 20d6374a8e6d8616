"""Verbs and families of verbs.

The module of a verb is imported only when the verb is used. So `arm --help` and every verb start
fast.
"""

import os
import signal
from collections.abc import Callable, Mapping, Sequence
from importlib import import_module
from typing import TYPE_CHECKING, cast

from arm_cli.errors import ArmCliError, UnansweredError
from arm_cli.output import complain, say_document
from arm_node.frozen import frozen
from arm_node.messages import MessageValueError

if TYPE_CHECKING:
    from arm_cli.arguments import CommandParser, Declaration, VerbFunction

EXIT_USAGE = 2


@frozen
class Verb:
    """One verb.

    Attributes:
        name: the word on the command line.
        help: one line of help.
        where: the module within arm_cli whose function of the verb's name runs it; for another
            name "MODULE:FUNCTION". `arm_cli.arguments.verb` decorates the function.
    """

    name: str
    help: str
    where: str

    def run(self, program: str, words: Sequence[str]) -> int:
        """Parse the words and run the verb; return the exit code."""
        options = self.parser(program).parse_words(words)
        run = self.load().run
        return run_reporting_errors(program, lambda: run(options))

    def load(self) -> "VerbFunction":
        """Import the verb's module; return its function."""
        module, _, name = self.where.partition(":")
        return getattr(import_module(f"arm_cli.{module}"), name or self.name)

    def arguments(self) -> "Sequence[Declaration]":
        """Return the verb's arguments."""
        return self.load().arguments

    def parser(self, program: str) -> "CommandParser":
        """Return the verb's parser."""
        from arm_cli.arguments import CommandParser

        parser = CommandParser(program, description=f"{self.help[0].upper()}{self.help[1:]}.")
        self.load().add_arguments(parser)
        return parser


@frozen
class PlainVerb:
    """A verb that parses its words itself.

    Its module within arm_cli has a function of the verb's name, `(words) -> int`, and maybe
    `ARGUMENTS`, for the Tab key.
    """

    name: str
    help: str
    module: str

    def arguments(self) -> "Sequence[Declaration]":
        """Return the verb's arguments, for the Tab key."""
        return getattr(import_module(f"arm_cli.{self.module}"), "ARGUMENTS", ())

    def run(self, program: str, words: Sequence[str]) -> int:
        """Run it with the words after the verb; return the exit code."""
        module = import_module(f"arm_cli.{self.module}")
        run = cast("Callable[[Sequence[str]], int]", getattr(module, self.name))
        return run_reporting_errors(program, lambda: run(words))


class VerbFamily:
    """Verbs that share a first word.

    `missing` has verbs of ros2 that do not exist here, each with a sentence that says why.
    """

    def __init__(
        self, name: str, help: str, *verbs: "Runnable", missing: Mapping[str, str] | None = None
    ) -> None:
        self.name, self.help, self.verbs, self.missing = name, help, verbs, missing or {}

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


Runnable = Verb | PlainVerb | VerbFamily
"""An entry in the table of verbs."""


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
            if not isinstance(error, ArmCliError | MessageValueError):
                raise
            complain(f"{program}: {error}{_who_is_stopped(error)}")
            return error.exit_code if isinstance(error, ArmCliError) else ArmCliError.exit_code


def _who_is_stopped(error: Exception) -> str:
    """Return which programs of the domain cannot answer because they are stopped."""
    if not isinstance(error, UnansweredError):
        return ""
    from arm_cli.domain_programs import describe_stopped, find_listeners

    sentence = describe_stopped(find_listeners(os.environ))
    return f"; {sentence}" if sentence else ""
