"""Make EmPy read each template once instead of once per interface.

EmPy scans a template character by character in Python and compiles its expressions, and does so
again for each file that it writes; this takes most of the generation. What it reads depends only on
the template's text, and running it changes nothing in it, so it can be kept.
"""

import functools
from collections.abc import Callable
from types import CodeType
from typing import Any

import em

_Token = Any


@functools.cache
def install() -> None:
    """Cache what is read in this process; do nothing for another version of EmPy."""
    if em.__version__.startswith("4."):
        em.Scanner.one = _cached(em.Scanner.one)
        em.evalFunc = functools.partial(_run, mode="eval")
        em.execFunc = functools.partial(_run, mode="exec")


def _cached(read_token: Callable[..., _Token]) -> Callable[..., _Token]:
    """Wrap EmPy's reading of a token so that it reads once per text and position."""
    tokens: dict[tuple[str, int], tuple[_Token, int]] = {}

    @functools.wraps(read_token)
    def look_up(scanner: em.Scanner, firebreaks: list[str] | None = None) -> _Token:
        if scanner.lock or scanner.pointer or firebreaks:  # within another token
            return read_token(scanner, firebreaks)
        key = (scanner.buffer, scanner.head)
        if key not in tokens:
            token = read_token(scanner)
            tokens[key] = (token, scanner.head)
            return token
        token, end = tokens[key]
        scanner.advance(end - scanner.head)
        scanner.sync()
        return token

    return look_up


def _run(code: str, *namespaces: dict[str, Any], mode: str) -> object:
    """Evaluate or execute Python text as ``eval`` and ``exec`` do."""
    return eval(_compile(code.lstrip(" \t") if mode == "eval" else code, mode), *namespaces)


@functools.cache
def _compile(code: str, mode: str) -> CodeType:
    """Compile a text for the first time in this process."""
    return compile(code, "<template>", mode)
