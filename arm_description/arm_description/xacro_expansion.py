"""xacro files to URDF text, with $(find package) and $(arg ...) working from pip."""

import os
import sys
from collections.abc import Iterator, Mapping
from contextlib import contextmanager
from pathlib import Path

from arm_description.errors import XacroError

_XACRO_NAMESPACE = "ros.org/wiki/xacro"


def expand_xacro(path: Path | str, arguments: Mapping[str, str] | None = None) -> str:
    """Return the URDF text of a xacro file; a plain .urdf passes through as it is.

    Not for several threads at a time: xacro keeps its state in its module.

    Args:
        path: the file.
        arguments: values for the file's <xacro:arg> elements, as text.

    Raises:
        XacroError: the file cannot be read or expanded; the message names the file and,
            where xacro knows it, the included file and the line.
    """
    file = Path(path)
    try:
        text = file.read_text(encoding="utf-8")
    except (OSError, ValueError) as error:
        raise XacroError(f"cannot read {file}: {_first_line(error)}") from error
    if file.suffix == ".urdf" and _XACRO_NAMESPACE not in text:
        return text
    return _process(file, {name: str(value) for name, value in (arguments or {}).items()})


def _process(file: Path, arguments: dict[str, str]) -> str:
    # xacro reports its errors through xml.parsers.expat without importing it.
    import xml.parsers.expat  # noqa: F401

    import xacro

    with _own_prefix_findable():
        try:
            document = xacro.process_file(str(file), mappings=arguments)
        # xacro runs the file's own expressions: whatever those raise comes out here.
        except Exception as error:
            where = "".join(f" in {name}" for name in _included_files(xacro, file))
            raise XacroError(f"cannot expand {file}: {_describe(error)}{where}") from error
        return str(document.toprettyxml(indent="  "))
