"""Prints and writes files: no other module of `arm_cli` writes to stdout or stderr.

Names and strings come from other processes, so all output is made safe for a terminal here.
"""

import argparse
import math
import shutil
import sys
from collections.abc import Iterable
from pathlib import Path
from typing import Any

from arm_cli.errors import CommandUsageError
from arm_node.printable import printable, printable_document, printable_message


def say(*lines: object) -> None:
    """Print each argument as one line."""
    for line in lines:
        print(printable(str(line)))


def say_in_place(line: str) -> None:
    """Print a line over the one that was printed so before; without a screen as a new line."""
    if not sys.stdout.isatty():
        say(line)
        return
    width = shutil.get_terminal_size().columns - 1
    print(f"\r\033[K{printable(line)[:width]}", end="", flush=True)


def say_document(text: str, end: str = "\n") -> None:
    """Print a text of several lines, such as YAML or a file."""
    print(printable_document(text), end=end)


def say_coloured(line: str) -> None:
    """Print a line whose parts `colour` or `printable` have already made safe."""
    print(line)


def complain(message: str) -> None:
    """Print a message on stderr, after all earlier output on stdout."""
    sys.stdout.flush()
    print(printable_message(message), file=sys.stderr, flush=True)


def print_json(value: Any) -> None:
    """Print a value as one line of JSON; numbers without a JSON form (nan, inf) become null."""
    # Imported here, because `arm --help` and the Tab key do without it.
    import json

    text = json.dumps(_finite(value), ensure_ascii=False)
    if printable(text) != text:
        # Escape with JSON's own escapes; the json module does not escape DEL.
        text = json.dumps(_finite(value)).replace("\x7f", "\\u007f")
    print(text)


def say_answer(options: argparse.Namespace, value: Any, lines: Iterable[object]) -> None:
    """Print what a verb found: with --json as JSON, else in lines."""
    if options.json:
        print_json(value)
    else:
        say(*lines)


def colour(code: int, text: str) -> str:
    """Return the text, made safe, in a colour (an SGR number) if stdout is a terminal."""
    safe = printable(text)
    return f"\033[{code}m{safe}\033[0m" if sys.stdout.isatty() else safe


def _finite(value: Any) -> Any:
    if isinstance(value, float):
        return value if math.isfinite(value) else None
    if isinstance(value, dict):
        return {key: _finite(item) for key, item in value.items()}
    if isinstance(value, (list, tuple)):
        return [_finite(item) for item in value]
    return value


def write_text(path: Path, text: str) -> None:
    """Write a file that the user asked for.

    Raises:
        CommandUsageError: the file cannot be written.
    """
    try:
        path.write_text(text, encoding="utf-8")
    except OSError as error:
        raise CommandUsageError(f"cannot write {path}: {error.strerror}") from error
