"""The hashes decide whether two ROS 2 processes take each other's types for the same."""

import ctypes
import importlib
from pathlib import Path


class TypeHash(ctypes.Structure):
    """The C struct of rosidl."""

    _fields_ = (("version", ctypes.c_uint8), ("value", ctypes.c_uint8 * 32))


def compiled_hash(type_name: str) -> str:
    """Read the hash out of the installed library, as the middleware does."""
    package = type_name.split("/")[0]
    folder = Path(importlib.import_module(package).__file__).parent
    library = ctypes.CDLL(str(folder / f"lib{package}__rosidl_typesupport_fastrtps_c.so"))
    function = getattr(library, f"{type_name.replace('/', '__')}__get_type_hash")
    function.argtypes = [ctypes.c_void_p]
    function.restype = ctypes.POINTER(TypeHash)
    type_hash = function(None).contents
    return f"RIHS{type_hash.version:02d}_{bytes(type_hash.value).hex()}"


def test_compiled_hashes_are_the_recorded_ones(recorded):
    assert {name: compiled_hash(name) for name in recorded} == recorded
