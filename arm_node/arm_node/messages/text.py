"""Converts messages to YAML, CSV and JSON, in the formats of `ros2 topic echo`."""

import array
from dataclasses import dataclass
from typing import Any

import numpy as np
import yaml

from arm_node.messages.fields import abbreviation, slots

try:
    from yaml import CSafeDumper as _Dumper
except ImportError:
    from yaml import SafeDumper as _Dumper

_UNLIMITED = 2**31 - 1
_SEQUENCES = (list, tuple, array.array, np.ndarray)


@dataclass(frozen=True, slots=True)
class Abridgement:
    """How much of a message to leave out.

    Attributes:
        truncate_length: longer arrays, strings and bytes are cut and end in "..."; None cuts none.
        no_arr: whether to print placeholders for arrays.
        no_str: whether to print placeholders for strings.
    """

    truncate_length: int | None = None
    no_arr: bool = False
    no_str: bool = False


COMPLETE = Abridgement()


def is_message(value: Any) -> bool:
    """Return whether a value is a message."""
    return hasattr(value, "get_fields_and_field_types")


def to_plain(value: Any, abridgement: Abridgement = COMPLETE, slot_type: Any = None) -> Any:
    """Return a message or a part of one as dicts, lists, strings and numbers."""
    if is_message(value):
        return {
            name: to_plain(getattr(value, name), abridgement, type_)
            for name, type_ in slots(value).items()
        }
    if isinstance(value, bytes):
        value = value.decode("latin-1")
        return _cut(value, abridgement)
    if isinstance(value, str):
        return (
            f"<string length: <{len(value)}>>" if abridgement.no_str else _cut(value, abridgement)
        )
    if isinstance(value, _SEQUENCES):
        return _plain_sequence(value, abridgement, slot_type)
    return value.item() if isinstance(value, np.generic) else value


def to_yaml(message: Any, abridgement: Abridgement = COMPLETE, flow_style: bool = False) -> str:
    """Return a message as YAML, ending in a newline."""
    return yaml.dump(
        to_plain(message, abridgement),
        Dumper=_Dumper,
        allow_unicode=True,
        width=_UNLIMITED,
        default_flow_style=flow_style,
        sort_keys=False,
    )


def to_csv(value: Any, abridgement: Abridgement = COMPLETE, slot_type: Any = None) -> str:
    """Return a message's values separated by commas, with nested values in place."""
    if is_message(value):
        return ",".join(
            to_csv(getattr(value, name), abridgement, type_) for name, type_ in slots(value).items()
        )
    if isinstance(value, _SEQUENCES):
        if abridgement.no_arr and slot_type is not None:
            return abbreviation(slot_type, len(value))
        cut = abridgement.truncate_length
        shown = [to_csv(item, abridgement) for item in value[:cut]]
        return ",".join([*shown, "..."] if len(shown) < len(value) else shown)
    return str(to_plain(value, abridgement))


def _plain_sequence(value: Any, abridgement: Abridgement, slot_type: Any) -> Any:
    if abridgement.no_arr and slot_type is not None:
        return abbreviation(slot_type, len(value))
    shown = value[: abridgement.truncate_length]
    if isinstance(shown, (array.array, np.ndarray)):
        items = shown.tolist()
    else:
        items = [to_plain(item, abridgement) for item in shown]
    return [*items, "..."] if len(shown) < len(value) else items


def _cut(text: str, abridgement: Abridgement) -> str:
    cut = abridgement.truncate_length
    return text if cut is None or len(text) <= cut else f"{text[:cut]}..."
