"""xacro files to URDF text, with $(find package) and $(arg ...) working from pip."""

import io
import re
from collections.abc import Callable, Iterator, Mapping, Sequence
from contextlib import contextmanager, redirect_stderr
from dataclasses import dataclass
from pathlib import Path
from typing import Any

from arm_description.errors import DescriptionError, XacroError
from arm_description.resources import find_package, folders_of

MOST_PLACES = 5
"""Of a stack of macros and files that a message names: an endless one has a thousand."""

_COMMENT = re.compile("<!--.*?-->", re.DOTALL)
_DOCTYPE = "<!DOCTYPE"
_XACRO_NAMESPACE = "xmlns:xacro"
"""What it stands for, xacro does not care: several addresses are in use."""


@dataclass(frozen=True, slots=True)
class XacroExpansion:
    """What a xacro file came to.

    Attributes:
        text: the URDF.
        arguments: the values of all arguments of the file, those by default too.
    """

    text: str
    arguments: Mapping[str, str]


def expand_xacro(path: Path | str, arguments: Mapping[str, str] | None = None) -> str:
    """Return the URDF text of a xacro file; as `expand_xacro_file`, without the arguments."""
    return expand_xacro_file(path, arguments).text


def expand_xacro_file(
    path: Path | str,
    arguments: Mapping[str, str] | None = None,
    package_path: Sequence[Path] = (),
) -> XacroExpansion:
    """Expand a xacro file; a plain .urdf passes through as it is.

    Not for several threads at a time: xacro keeps its state in its module.

    Args:
        path: the file.
        arguments: values for the file's <xacro:arg> elements, as text.
        package_path: folders for $(find NAME), before the file's own package and its neighbours;
            those that are installed go before all of them.

    Raises:
        XacroError: the file cannot be read or expanded; the message names the file and,
            where xacro knows it, the included file and the line.
    """
    file = Path(path)
    values = {name: str(value) for name, value in (arguments or {}).items()}
    try:
        text = file.read_text(encoding="utf-8")
    except OSError as error:
        raise XacroError(f"cannot read {file}: {error.strerror}") from error
    except ValueError as error:
        raise XacroError(f"cannot read {file}: {_first_line(error)}") from error
    if file.suffix == ".urdf" and _XACRO_NAMESPACE not in text:
        return XacroExpansion(text, values)
    if _DOCTYPE in _COMMENT.sub("", text):
        raise XacroError(f"{file} has a DOCTYPE, which is not accepted; remove it")
    # xacro adds the defaults of the file's arguments to the dict that it is given.
    text = _process(file, values, (*package_path, *folders_of(file)))
    return XacroExpansion(text, values)


def _process(file: Path, arguments: dict[str, str], package_path: Sequence[Path]) -> str:
    # xacro reports its errors through xml.parsers.expat without importing it.
    import xml.parsers.expat  # noqa: F401 # pyright: ignore[reportUnusedImport]

    import xacro

    # xacro would import it in the midst of an expansion, and make an interrupt there an error.
    import xacro.substitution_args  # pyright: ignore[reportUnusedImport]

    with _findable(package_path):
        try:
            document: Any = xacro.process_file(str(file), mappings=arguments)
        # xacro runs the file's own expressions: whatever those raise comes out here.
        except Exception as error:
            place = _place(xacro.print_location)
            raise XacroError(f"cannot expand {file}: {_reason(error)}; {place}") from error
    return str(document.toprettyxml(indent="  "))


def _reason(error: Exception) -> str:
    # xacro wraps what it does not know, and says it twice.
    wrapped = getattr(error, "exc", None)
    return _first_line(wrapped if isinstance(wrapped, DescriptionError) else error)


def _place(print_location: Callable[[], None]) -> str:
    # xacro tells its stack of macros and files only to stderr.
    told = io.StringIO()
    with redirect_stderr(told):
        print_location()
    places = [line for line in told.getvalue().split("\n") if line]
    return ", ".join(places if len(places) <= MOST_PLACES else [*places[:MOST_PLACES], "..."])


def _first_line(error: BaseException) -> str:
    text = str(error).strip()
    return text.splitlines()[0] if text else type(error).__name__


@contextmanager
def _findable(package_path: Sequence[Path]) -> Iterator[None]:
    """Let $(find) look where package:// is looked for.

    xacro asks ament alone, which knows installed packages only, and not those of pip.
    """
    from ament_index_python import packages

    asked = packages.get_package_share_directory

    def find(package_name: str) -> str:
        return str(find_package(package_name, package_path))

    packages.get_package_share_directory = find
    try:
        yield
    finally:
        packages.get_package_share_directory = asked
