"""Reads the values of recordings of format 1, which are JSON.

Numbers keep their bits. A dataclass or an enum is named by its module and its name.
"""

import base64
import dataclasses
import json
from enum import Enum
from typing import Any

import numpy as np

from arm_control.state.class_names import class_named


def read_json(content: bytes) -> Any:
    """Return the value of a record.

    Raises:
        ValueError: it names a class that does not exist, or is damaged.
    """
    try:
        return _value(json.loads(content))
    except (KeyError, TypeError, AttributeError, ImportError) as error:
        raise ValueError(f"{type(error).__name__}: {error}") from error


def _value(data: Any) -> Any:
    match data:
        case [*items]:
            return tuple(map(_value, items))
        case {"!list": items}:
            return [_value(item) for item in items]
        case {"!set": items}:
            return {_value(item) for item in items}
        case {"!dict": pairs}:
            return {_value(key): _value(item) for key, item in pairs}
        case {"!bytes": text}:
            return base64.b64decode(text)
        case {"!array": text, "dtype": dtype, "shape": shape}:
            array = np.frombuffer(base64.b64decode(text), dtype=np.dtype(dtype))
            return array.reshape(shape).copy()
        case {"!enum": name, "name": member}:
            return _class(name, Enum)[member]
        case {"!data": name, **fields}:
            values = {key: _value(item) for key, item in fields.items()}
            return _class(name, None)(**values)
        case dict():
            return {key: _value(item) for key, item in data.items()}
        case _:
            return data


def _class(name: str, base: type | None) -> Any:
    """Return a dataclass, or a class that derives from `base`, by its name."""
    found = class_named(name)
    is_fit = isinstance(found, type) and (
        issubclass(found, base) if base is not None else dataclasses.is_dataclass(found)
    )
    if not is_fit:
        raise ValueError(f"there is no class '{name}' here")
    return found
