"""Make the rosidl generators do once in a process what they do again for each file.

``parse_cache``: each generator parses every IDL file again with a slow Earley parser, which takes a
quarter of the whole generation. Their templates only read the result, so one parse serves all of
them.

``template_cache``: EmPy scans a template character by character in Python and compiles its
expressions, and does so again for each file that it writes; this takes most of the generation. What
it reads depends only on the template's text, and running it changes nothing in it, so it can be
kept.
"""

import functools
import os
from collections.abc import Callable
from pathlib import Path
from types import CodeType
from typing import Any

import em
import rosidl_generator_py.generate_py_impl
import rosidl_generator_type_description
import rosidl_pycommon
from rosidl_parser.definition import IdlFile, IdlLocator
from rosidl_parser.parser import parse_idl_file

_PARSE = parse_idl_file.__name__
_PARSING_MODULES = (
    rosidl_generator_py.generate_py_impl,
    rosidl_generator_type_description,
    rosidl_pycommon,
)

_Token = Any


def install() -> None:
    """Cache repeated work of the generators in this worker process.

    ARM_WITHOUT switches the caches off by name, like the workarounds of the suite.
    """
    off = {word.strip() for word in os.environ.get("ARM_WITHOUT", "").split(",")}
    for name, install_one in _CACHES.items():
        if off.isdisjoint({name, "all"}):
            install_one()


def _cache_parses() -> None:
    """Replace the parser in every generator by a caching one."""
    for module in _PARSING_MODULES:
        setattr(module, _PARSE, _parse)


def _parse(locator: IdlLocator) -> IdlFile:
    """Return the parse of a file, from the cache if possible."""
    return _parse_once(Path(locator.basepath), Path(locator.relative_path))


@functools.cache
def _parse_once(folder: Path, relative_path: Path) -> IdlFile:
    """Parse a file for the first time in this process."""
    return parse_idl_file(IdlLocator(folder, relative_path))


@functools.cache
def _cache_templates() -> None:
    """Cache what EmPy reads; do nothing for another version of it."""
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


_CACHES = {"parse_cache": _cache_parses, "template_cache": _cache_templates}
