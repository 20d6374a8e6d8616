"""Values for a xacro file's arguments, as they are written in a shell: NAME:=VALUE."""

import shlex
from collections.abc import Iterable

from arm_description.errors import XacroError

ASSIGNMENT = ":="


def arguments_of_words(words: Iterable[str]) -> dict[str, str]:
    """Return the xacro arguments of words NAME:=VALUE.

    Raises:
        XacroError: a word that is none.
    """
    arguments: dict[str, str] = {}
    for word in words:
        name, assignment, value = word.partition(ASSIGNMENT)
        if not (name and assignment):
            raise XacroError(f"the xacro argument {word!r} is not NAME:=VALUE")
        arguments[name] = value
    return arguments


def arguments_of_text(text: str) -> dict[str, str]:
    """Return the xacro arguments of a text with blanks between them, and quotes as in a shell.

    Raises:
        XacroError: a quote without its end, or a word that is no argument.
    """
    try:
        words = shlex.split(text)
    except ValueError as error:
        raise XacroError(f"the xacro arguments {text!r}: {error}") from error
    return arguments_of_words(words)
