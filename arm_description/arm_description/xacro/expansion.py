"""Expands xacro files; $(find PACKAGE) and $(arg NAME) work without a sourced ROS 2."""

import io
import re
import shlex
from collections.abc import Iterable, Iterator, Mapping, Sequence
from contextlib import contextmanager
from functools import cache
from pathlib import Path
from typing import Any

from arm_description.errors import DescriptionError, XacroError
from arm_description.resources import ResourceFinder
from arm_description.urdf.description_source import with_source
from arm_node.collection import collection_paused
from arm_node.frozen import frozen
from arm_node.limited_yaml import YamlError, check_yaml
from arm_node.user_file import UnusableFileError, read_text

ASSIGNMENT = ":="


def arguments_of_words(words: Iterable[str]) -> dict[str, str]:
    """Return the xacro arguments in words of the form NAME:=VALUE.

    Raises:
        XacroError: a word has another form.
    """
    arguments: dict[str, str] = {}
    for word in words:
        name, assignment, value = word.partition(ASSIGNMENT)
        if not (name and assignment):
            raise XacroError(f"the xacro argument {word!r} is not NAME:=VALUE")
        arguments[name] = value
    return arguments


def arguments_of_text(text: str) -> dict[str, str]:
    """Return the xacro arguments in a text, separated by blanks, with quotes as in a shell.

    Raises:
        XacroError: a quote is not closed, or a word is not an argument.
    """
    try:
        words = shlex.split(text)
    except ValueError as error:
        raise XacroError(f"the xacro arguments {text!r}: {error}") from error
    return arguments_of_words(words)


MAX_PLACES = 5
"""Maximum macros and files that a message names: an endless recursion has a thousand."""

_COMMENT = re.compile("<!--.*?-->", re.DOTALL)
_POSITION = re.compile(r": line \d+, column \d+\Z")
"""The end of expat's messages, which is removed because the line is reported separately."""
_DOCTYPE = "<!DOCTYPE"
_XACRO_NAMESPACE = "xmlns:xacro"
"""xacro ignores the namespace's URI, and several are in use."""


@frozen
class XacroExpansion:
    """The result of expanding a xacro file.

    Attributes:
        text: the URDF, which contains the path of its file, see `description_source`.
        arguments: the values of all arguments of the file, including defaults.
        finder: finds the packages and files that the xacro file and the URDF name.
        source: name of the text in messages: its line numbers are the file's only if nothing was
            expanded.
    """

    text: str
    arguments: Mapping[str, str]
    finder: ResourceFinder
    source: str


def expand_xacro(path: Path | str, arguments: Mapping[str, str] | None = None) -> str:
    """Return the URDF text of a xacro file; see `expand_xacro_file`."""
    return expand_xacro_file(path, arguments).text


def expand_xacro_file(
    path: Path | str,
    arguments: Mapping[str, str] | None = None,
    package_path: Sequence[Path] = (),
) -> XacroExpansion:
    """Expand a xacro file; a plain .urdf is returned unchanged.

    One thread at a time, because xacro keeps its state in its module.

    Args:
        path: the file.
        arguments: values for the file's <xacro:arg> elements, as text.
        package_path: folders for $(find NAME), searched after the file's own package and before its
            neighbours and installed packages.

    Raises:
        XacroError: the file cannot be read or expanded; the message names the file and, if known,
            the included file and the line.
    """
    file = Path(path)
    values = {name: str(value) for name, value in (arguments or {}).items()}
    try:
        text = read_text(file)
    except OSError as error:
        raise XacroError(f"cannot read {file}: {error.strerror}") from error
    except ValueError as error:
        raise XacroError(f"cannot read {file}: {_first_line(error)}") from error
    if file.suffix == ".urdf" and _XACRO_NAMESPACE not in text:
        text = with_source(text, file, package_path)
        finder = ResourceFinder.of_description(text, package_path)
        return XacroExpansion(text, values, finder, str(file))
    if _has_doctype(text):
        raise XacroError(f"{file} has a DOCTYPE, which is not accepted; remove it")
    # xacro adds the defaults of the file's arguments to the given dict.
    finder = ResourceFinder(file, package_path)
    text = _process(file, values, finder)
    text = with_source(text, file, package_path)
    return XacroExpansion(text, values, finder, f"{file}, expanded")


def _process(file: Path, arguments: dict[str, str], finder: ResourceFinder) -> str:
    # xacro reports its errors through xml.parsers.expat without importing it.
    import xml.parsers.expat  # noqa: F401 # pyright: ignore[reportUnusedImport]

    import xacro

    # xacro would import it during an expansion, and turn an interrupt there into an error.
    import xacro.substitution_args  # pyright: ignore[reportUnusedImport]

    # Imported here, because only an expansion needs a second XML parser.
    from arm_description.xacro.lines import lines_kept

    # Its documents have thousands of nodes, which the collector would look through again and again.
    with collection_paused():
        with findable(finder), _files_limited(), _text_read_once(), lines_kept():
            try:
                document: Any = xacro.process_file(str(file), mappings=arguments)
            # xacro evaluates the file's expressions, which may raise anything.
            except Exception as error:
                place, way = _where(file, error)
                raise XacroError(f"cannot expand {place}: {_reason(error)}{way}") from error
        return str(document.toprettyxml(indent="  "))


@contextmanager
def _files_limited() -> Iterator[None]:
    """Make xacro read included files and YAML with this suite's limits.

    xacro itself opens any file: a FIFO blocks it, and YAML aliases can fill the memory.
    """
    import xacro

    # A name in the module hides the built-in function.
    xacro.open = _opened  # pyright: ignore[reportAttributeAccessIssue]
    try:
        yield
    finally:
        del xacro.open  # pyright: ignore[reportAttributeAccessIssue]


@contextmanager
def _text_read_once() -> Iterator[None]:
    """Spare xacro its lexer for texts without a `$`, and the compiler for expressions it has seen.

    Four of five texts are plain, and xacro returns them as they are; to look through them takes a
    seventh of the time. Each use of a macro has the same expressions; compiling them takes a tenth.
    """
    import xacro

    original: Any = xacro.eval_text

    def eval_text(text: str | None, symbols: Any) -> Any:
        return text if text and "$" not in text else original(text, symbols)

    xacro.eval_text = eval_text
    # A name in the module hides the built-in function.
    xacro.compile = cache(compile)  # pyright: ignore[reportAttributeAccessIssue]
    try:
        yield
    finally:
        xacro.eval_text = original
        del xacro.compile  # pyright: ignore[reportAttributeAccessIssue]


def _opened(name: str) -> io.StringIO:
    text = read_text(name)
    if _has_doctype(text):
        raise UnusableFileError("it has a DOCTYPE, which is not accepted", Path(name))
    if not text.lstrip("\ufeff \t\n").startswith("<"):
        # It is not XML, so the caller is `xacro.load_yaml`.
        try:
            check_yaml(text)
        except YamlError as error:
            raise UnusableFileError(str(error), Path(name)) from error
    return io.StringIO(text)


def _has_doctype(text: str) -> bool:
    return _DOCTYPE in _COMMENT.sub("", text)


def _reason(error: Exception) -> str:
    # xacro wraps unknown exceptions and repeats their message.
    wrapped = getattr(error, "exc", None)
    cause: Exception | None = error
    while cause is not None:
        if isinstance(cause, UnusableFileError):
            return f"{cause.filename}: {cause}"
        if isinstance(cause, MemoryError):
            return "there is not enough memory"
        if isinstance(cause, RecursionError):
            return "the recursion does not end"
        if isinstance(cause, OSError) and cause.filename:
            return f"cannot read {cause.filename}: {cause.strerror}"
        cause = getattr(cause, "exc", None)
    if wrapped is not None and str(error.args[0]).startswith("<class "):
        return _first_line(wrapped)
    return _first_line(wrapped if isinstance(wrapped, DescriptionError) else error)


def _where(file: Path, error: Exception) -> tuple[str, str]:
    """Return the place of an error, and the macros and files that led there."""
    import xacro

    from arm_description.xacro.lines import place_of

    files = [str(name) for name in xacro.filestack or () if name]
    macros = [str(macro.body.getAttribute("name")) for macro in reversed(xacro.macrostack or ())]
    place = place_of(error, files)
    known = {str(file), place.file}
    included = [name for name in dict.fromkeys(reversed(files)) if name not in known]
    steps = [
        *(f"in macro: {name}" for name in macros),
        *(f"included from: {name}" for name in included),
    ]
    way = ", ".join(steps if len(steps) <= MAX_PLACES else [*steps[:MAX_PLACES], "..."])
    own = place.file == str(file)
    start = str(place) if own else f"{file}: {place}"
    return start, f"; {way}" if way else ""


def _first_line(error: BaseException) -> str:
    text = _POSITION.sub("", str(error).strip())
    return text.splitlines()[0].strip() if text else type(error).__name__


@contextmanager
def findable(finder: ResourceFinder) -> Iterator[None]:
    """Make $(find) search the same places as package://.

    xacro itself only asks ament, which does not know packages installed by pip.
    """
    from ament_index_python import packages

    asked = packages.get_package_share_directory

    def find(package_name: str) -> str:
        return str(finder.package(package_name))

    packages.get_package_share_directory = find
    try:
        yield
    finally:
        packages.get_package_share_directory = asked
