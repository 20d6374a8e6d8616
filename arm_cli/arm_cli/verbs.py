"""The verbs of `arm`: name, one line of help, and the module that carries it out.

A verb's module is imported only when the verb is used, so that `arm --help` and every verb start
fast. It defines `run(argv) -> int`, which gets the words after the verb.
"""

from collections.abc import Callable, Sequence
from dataclasses import dataclass
from importlib import import_module
from typing import cast

VerbFunction = Callable[[Sequence[str]], int]


@dataclass(frozen=True, slots=True)
class Verb:
    """One verb of the command."""

    name: str
    help: str
    module: str

    def run(self, argv: Sequence[str]) -> int:
        """Carry it out with the words after the verb; return the exit code."""
        return cast("VerbFunction", import_module(self.module).run)(argv)


VERBS = (Verb("launch", "start the simulated arm, or any launch file", "arm_cli.launch_verb"),)
