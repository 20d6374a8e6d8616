"""The part of a message that `--field` names: `pose.position`, `points[0].positions`."""

import re
from dataclasses import dataclass
from typing import Any

from rosidl_parser.definition import AbstractNestedType, NamespacedType

from arm_cli.errors import MessageError
from arm_cli.messages.field_types import message_class, slots, type_name

_STEP = re.compile(r"(\w+)|\[(\d+)\]")


@dataclass(frozen=True, slots=True)
class FieldPath:
    """Steps from a message to one of its parts: names of fields and indices into lists."""

    text: str
    steps: tuple[str | int, ...]

    @classmethod
    def parse(cls, text: str) -> "FieldPath":
        """Read a path.

        Raises:
            MessageError: it is no path.
        """
        steps: list[str | int] = []
        for part in filter(None, text.split(".")):
            matches = list(_STEP.finditer(part))
            if "".join(match.group() for match in matches) != part:
                raise MessageError(f"{part!r} in --field {text!r} is no name of a field")
            steps += [match[1] if match[1] else int(match[2]) for match in matches]
        if not steps:
            raise MessageError(f"--field {text!r} names no field")
        return cls(text, tuple(steps))

    def check(self, message: type) -> None:
        """Check the path against a message class.

        Raises:
            MessageError: there is no such field.
        """
        current: Any = message
        type_: Any = None
        for step in self.steps:
            if isinstance(step, int):
                if not isinstance(type_, AbstractNestedType):
                    raise MessageError(f"--field {self.text}: [{step}] follows what is no list")
                type_ = type_.value_type
            elif current is None:
                raise MessageError(f"--field {self.text}: {type_name(type_)} has no fields")
            elif step not in (known := slots(current)):
                raise MessageError(
                    f"--field {self.text}: no field {step!r} (fields: {', '.join(known)})"
                )
            else:
                type_ = known[step]
            current = message_class(type_) if isinstance(type_, NamespacedType) else None

    def of(self, message: Any) -> Any:
        """Return the part of a message.

        Raises:
            MessageError: a list is too short.
        """
        part = message
        for step in self.steps:
            if isinstance(step, str):
                part = getattr(part, step)
            elif step < len(part):
                part = part[step]
            else:
                raise MessageError(f"--field {self.text}: the list has {len(part)} items")
        return part
