"""Make the rosidl generators share one parse of each IDL file.

Each generator parses every file again with a slow Earley parser, which takes a quarter of the whole
generation. Their templates only read the result, so one parse serves all of them.
"""

import functools
from pathlib import Path

import rosidl_generator_py.generate_py_impl
import rosidl_generator_type_description
import rosidl_pycommon
from rosidl_parser.definition import IdlFile, IdlLocator
from rosidl_parser.parser import parse_idl_file

_NAME = parse_idl_file.__name__
_READERS = (
    rosidl_generator_py.generate_py_impl,
    rosidl_generator_type_description,
    rosidl_pycommon,
)


def install() -> None:
    """Replace the parser in every generator by a caching one; only for a worker process."""
    for module in _READERS:
        setattr(module, _NAME, _parse)


def _parse(locator: IdlLocator) -> IdlFile:
    """Return the parse of a file, from the cache if possible."""
    return _parse_once(Path(locator.basepath), Path(locator.relative_path))


@functools.cache
def _parse_once(folder: Path, relative_path: Path) -> IdlFile:
    """Parse a file for the first time in this process."""
    return parse_idl_file(IdlLocator(folder, relative_path))
