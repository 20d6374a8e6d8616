"""Parts of messages on the command line: `--field` and `--filter`."""

import re
from collections.abc import Callable
from dataclasses import dataclass
from typing import Any

from rosidl_parser.definition import AbstractNestedType, NamespacedType

from arm_cli.arguments import Argument
from arm_cli.errors import CommandUsageError, MessageError
from arm_node.messages.fields import message_class, slots, type_name

_RAISED = (ArithmeticError, AttributeError, LookupError, NameError, TypeError, ValueError)
"""Exceptions of a filter expression that does not fit the messages."""

_STEP = re.compile(r"(\w+)|\[(\d+)\]")


FILTER = Argument(
    "--filter", metavar="EXPRESSION", help="only messages m for which this Python holds"
)


def message_filter(expression: str) -> Callable[[Any], bool]:
    """Return a predicate of messages from an expression that calls the message `m`.

    The predicate raises a MessageError if the expression fails for a message.

    Raises:
        CommandUsageError: the text is not a Python expression.
    """
    try:
        code = compile(expression, "--filter", "eval")
    except (SyntaxError, ValueError) as error:
        raise CommandUsageError(f"--filter {expression!r} is not a Python expression") from error

    def fits(message: Any) -> bool:
        try:
            return bool(eval(code, {"m": message}))
        except _RAISED as error:
            text = f"{type(error).__name__}: {error}"
            raise MessageError(f"--filter {expression!r} fails: {text}") from error

    return fits


@dataclass(frozen=True, slots=True)
class FieldPath:
    """A path from a message to one of its parts, by names of fields and indices of lists."""

    text: str
    steps: tuple[str | int, ...]

    @classmethod
    def parse(cls, text: str) -> "FieldPath":
        """Parse a path.

        Raises:
            MessageError: the text is not a path.
        """
        steps: list[str | int] = []
        for part in filter(None, text.split(".")):
            matches = list(_STEP.finditer(part))
            if "".join(match.group() for match in matches) != part:
                raise MessageError(f"{part!r} in --field {text!r} is not a field name")
            steps += [match[1] if match[1] else int(match[2]) for match in matches]
        if not steps:
            raise MessageError(f"--field {text!r} does not name a field")
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
                    raise MessageError(f"--field {self.text}: [{step}] does not follow a list")
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
