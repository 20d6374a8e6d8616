"""Writes values as JSON and reads them: numbers, text, arrays, collections, dataclasses, enums.

Numbers keep their bits. A dataclass or an enum is named by its module and its name. Reading never
imports a module outside of the suite, so that a file from a stranger cannot run code.
"""

import base64
import dataclasses
import importlib
import sys
from array import array
from collections.abc import Mapping
from enum import Enum
from typing import Any

import numpy as np

PACKAGES = ("arm_control", "arm_description", "arm_gazebo", "arm_node", "arm_sim")
"""Packages that reading a file may import."""


class PlainDataError(ValueError):
    """A value cannot be written, or a text cannot be read; the message says where in it."""


def to_plain(value: object, path: str = "value") -> Any:
    """Return what `json.dumps` takes for a value.

    Args:
        value: None, bool, int, float, str, bytes, an array (read back as a NumPy array), a NumPy
            number, an Enum, or a tuple, list, set, mapping or dataclass of them.
        path: what the value is, for error messages.

    Raises:
        PlainDataError: it contains something else.
    """
    match value:
        case Enum():
            return {"!enum": class_name(type(value)), "name": value.name}
        case None | bool() | int() | float() | str():
            return value
        case bytes():
            return {"!bytes": base64.b64encode(value).decode()}
        case array():
            return to_plain(np.array(value), path)
        case np.ndarray() if value.dtype.kind in "biuf":
            data = base64.b64encode(value.tobytes()).decode()
            return {"!array": data, "dtype": value.dtype.str, "shape": list(value.shape)}
        case np.generic() if value.dtype.kind in "biuf":
            return value.item()
        case tuple():
            return [to_plain(item, f"{path}[{i}]") for i, item in enumerate(value)]
        case list():
            return {"!list": [to_plain(item, f"{path}[{i}]") for i, item in enumerate(value)]}
        case set() | frozenset():
            items = sorted(value, key=repr)
            return {"!set": [to_plain(item, f"an item of {path}") for item in items]}
        case Mapping():
            return _mapping_to_plain(value, path)
        case _ if dataclasses.is_dataclass(value) and not isinstance(value, type):
            fields = {
                field.name: to_plain(getattr(value, field.name), f"{path}.{field.name}")
                for field in dataclasses.fields(value)
                if field.init
            }
            return {"!data": class_name(type(value)), **fields}
        case _:
            kind = f"{type(value).__module__}.{type(value).__qualname__}"
            raise PlainDataError(f"{path} is a {kind}, which is not plain data")


def from_plain(data: Any, path: str = "value") -> Any:
    """Return the value that `to_plain` has written.

    Raises:
        PlainDataError: it names a class that does not exist, or is not as `to_plain` writes it.
    """
    try:
        return _from_plain(data, path)
    except PlainDataError:
        raise
    except (KeyError, TypeError, ValueError, AttributeError, ImportError) as error:
        raise PlainDataError(f"{path} cannot be read: {type(error).__name__}: {error}") from error


def _mapping_to_plain(value: Mapping[Any, Any], path: str) -> Any:
    if all(isinstance(key, str) and not key.startswith("!") for key in value):
        return {key: to_plain(item, f"{path}['{key}']") for key, item in value.items()}
    pairs = [
        [to_plain(key, f"a key of {path}"), to_plain(item, f"{path}[{key!r}]")]
        for key, item in value.items()
    ]
    return {"!dict": pairs}


def _from_plain(data: Any, path: str) -> Any:
    match data:
        case [*items]:
            return tuple(_from_plain(item, f"{path}[{i}]") for i, item in enumerate(items))
        case {"!list": items}:
            return [_from_plain(item, f"{path}[{i}]") for i, item in enumerate(items)]
        case {"!set": items}:
            return {_from_plain(item, f"an item of {path}") for item in items}
        case {"!dict": pairs}:
            return {_from_plain(k, path): _from_plain(v, f"{path}[{k!r}]") for k, v in pairs}
        case {"!bytes": text}:
            return base64.b64decode(text)
        case {"!array": text, "dtype": dtype, "shape": shape}:
            array = np.frombuffer(base64.b64decode(text), dtype=np.dtype(dtype))
            return array.reshape(shape).copy()
        case {"!enum": name, "name": member}:
            return _class_of(name, Enum)[member]
        case {"!data": name, **fields}:
            values = {key: _from_plain(item, f"{path}.{key}") for key, item in fields.items()}
            return _class_of(name, None)(**values)
        case dict():
            return {key: _from_plain(item, f"{path}['{key}']") for key, item in data.items()}
        case _:
            return data


def class_name(cls: type) -> str:
    """Return the name of a class for `class_named`: 'module:Name'."""
    return f"{cls.__module__}:{cls.__qualname__}"


def class_named(name: str) -> Any:
    """Return the object named 'module:Name', or None if there is none; see `PACKAGES`.

    Raises:
        ImportError: a module of the suite does not exist, or cannot be imported.
    """
    module_name, _, qualified = name.partition(":")
    if module_name.partition(".")[0] in PACKAGES:
        found: Any = importlib.import_module(module_name)
    else:
        found = sys.modules.get(module_name)
    for part in qualified.split("."):
        found = getattr(found, part, None)
    return found


def _class_of(name: str, base: type | None) -> Any:
    """Return a dataclass, or a class that derives from `base`, by its name."""
    found = class_named(name)
    is_fit = isinstance(found, type) and (
        issubclass(found, base) if base is not None else dataclasses.is_dataclass(found)
    )
    if not is_fit:
        raise PlainDataError(f"there is no class '{name}' here")
    return found
