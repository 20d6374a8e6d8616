"""Converts the values of parameters to the types that a node uses.

ROS infers the type of a parameter from its notation: `2` is not a double, and `[1, 0]` is not a
list of doubles. These readers accept both. Each raises `ParameterValueError` for any other value;
the message says what the value must be, and `read_parameter` adds the name.
`arm_node.parameters` declares the parameters.
"""

import math
from array import array
from collections.abc import Callable, Iterable
from typing import TypeGuard, TypeVar

from arm_node.frozen import frozen

Value = TypeVar("Value")
Reader = Callable[[object], Value]


class ParameterValueError(Exception):
    """A parameter of a node has an invalid value.

    Attributes:
        wanted: what the value must be, such as "a number above 0"; empty if unknown.
    """

    wanted: str = ""


def read_parameter(name: str, value: object, read: Reader[Value]) -> Value:
    """Return a parameter's value, converted by `read`.

    Raises:
        ParameterValueError: `read` refuses the value; the message begins with the name.
    """
    try:
        return read(value)
    except ParameterValueError as error:
        raise ParameterValueError(f"{name} {error}") from error


def read_flag(value: object) -> bool:
    """Return true or false."""
    if not isinstance(value, bool):
        raise refusal("true or false", value)
    return value


@frozen
class IntegerReader:
    """Reads a whole number.

    Attributes:
        wanted: what the value must be, in words.
        least: smallest allowed value.
        most: largest allowed value.
    """

    wanted: str = "a whole number"
    least: float = -math.inf
    most: float = math.inf

    def __call__(self, value: object) -> int:
        """Return the number."""
        if isinstance(value, bool) or not isinstance(value, int):
            raise refusal(self.wanted, value)
        if not self.least <= value <= self.most:
            raise refusal(self.wanted, value)
        return value


@frozen
class NumberReader:
    """Reads a finite number.

    Attributes:
        wanted: what the value must be, in words.
        least: smallest allowed value.
        most: largest allowed value.
        above: whether the value must be above `least`.
    """

    wanted: str
    least: float = -math.inf
    most: float = math.inf
    above: bool = False

    def __call__(self, value: object) -> float:
        """Return the number."""
        if not is_finite(value) or not self.least <= value <= self.most:
            raise refusal(self.wanted, value)
        if self.above and value == self.least:
            raise refusal(self.wanted, value)
        return float(value)


read_integer = IntegerReader()
read_number = NumberReader("a finite number")
read_non_negative = NumberReader("a finite number of at least 0", least=0.0)


def read_text(value: object, wanted: str = "a text") -> str:
    """Return a string, which may be empty."""
    if not isinstance(value, str):
        raise refusal(wanted, value)
    return value


def read_nonempty_text(value: object, wanted: str = "a text") -> str:
    """Return a string that is not empty."""
    if not isinstance(value, str) or not value:
        raise refusal(wanted, value)
    return value


def one_of(choices: Iterable[str]) -> Reader[str]:
    """Return a reader that accepts one of these strings."""
    choices = tuple(choices)

    def read(value: object) -> str:
        if not isinstance(value, str) or value not in choices:
            raise refusal(f"one of {', '.join(choices)}", value)
        return value

    return read


def read_texts(value: object, wanted: str = "a list of texts") -> tuple[str, ...]:
    """Return non-empty strings; an empty list in a YAML file arrives as None."""
    if value is None:
        return ()
    if not isinstance(value, list | tuple) or not all(isinstance(x, str) and x for x in value):
        raise refusal(wanted, value)
    return tuple(value)


def read_words(value: object) -> tuple[str, ...]:
    """Return strings from a list, or from one string with commas or blanks."""
    return read_texts(value.replace(",", " ").split() if isinstance(value, str) else value)


def read_numbers(value: object) -> tuple[float, ...]:
    """Return finite numbers; a string such as `[1, 0.5]` counts as a list, see `numbers_in`."""
    values = numbers_in(value)
    if not isinstance(values, list | tuple | array) or not all(map(is_finite, values)):
        raise refusal("a list of finite numbers", value)
    return tuple(map(float, values))


def numbers_in(value: object) -> object:
    """Return the list in a string such as `[1, 0.5]`; any other value unchanged.

    ROS has no list of integers and doubles, so its command line sends one as a string.
    """
    words = value.strip() if isinstance(value, str) else ""
    if not (words.startswith("[") and words.endswith("]")):
        return value
    try:
        return [float(word) for word in words[1:-1].split(",")]
    except ValueError:
        return value


def is_number(value: object) -> TypeGuard[float]:
    """Return whether a value is a number; true and false are not."""
    return isinstance(value, int | float) and not isinstance(value, bool)


def is_finite(value: object) -> TypeGuard[float]:
    """Return whether a value is a finite number."""
    return is_number(value) and math.isfinite(value)


def refusal(wanted: str, value: object) -> ParameterValueError:
    """Return the error "must be WANTED, not VALUE"."""
    error = ParameterValueError(f"must be {wanted}, not {value!r}")
    error.wanted = wanted
    return error


def range_of(read: Reader[object]) -> tuple[float, float] | None:
    """Return the smallest and largest number that a reader accepts; None if there is no bound."""
    if not isinstance(read, IntegerReader | NumberReader):
        return None
    bounds = (read.least, read.most)
    return None if bounds == (-math.inf, math.inf) else bounds


def wanted_by(read: Reader[object]) -> str:
    """Return what a reader accepts, in the words of its error message."""
    try:
        read(object())
    except ParameterValueError as error:
        return error.wanted
    return ""
