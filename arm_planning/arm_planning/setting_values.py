"""Reads single values of parameters and of YAML files, whose types nobody has looked at."""

import sys
from math import inf

from arm_planning.errors import SettingError


def number(
    name: str,
    value: object,
    *,
    above: float = -inf,
    below: float = inf,
    least: float = -inf,
    most: float = inf,
) -> float:
    """Return a finite number.

    Args:
        name: what the error calls it, such as a parameter's full name.
        value: what stands there.
        above: what it is greater than.
        below: what it is smaller than.
        least: the smallest that is accepted.
        most: the greatest that is accepted.

    Raises:
        SettingError: it is no finite number, or out of these bounds.
    """
    if isinstance(value, bool) or not isinstance(value, int | float):
        raise SettingError(f"{name} is {value!r}, which is not a finite number")
    # YAML's integers have no bounds, and `isfinite` raises an error above a float's.
    if not abs(value) <= sys.float_info.max:
        raise SettingError(f"{name} is {value!r}, which is not a finite number")
    if not (above < value < below and least <= value <= most):
        bounds = (("above", above), ("below", below), ("at least", least), ("at most", most))
        wanted = " and ".join(f"{word} {bound:g}" for word, bound in bounds if abs(bound) < inf)
        raise SettingError(f"{name} is {value!r}; it is {wanted}")
    return float(value)


def switch(name: str, value: object) -> bool:
    """Return true or false.

    Raises:
        SettingError: it is neither.
    """
    if not isinstance(value, bool):
        raise SettingError(f"{name} is {value!r}; it is true or false")
    return value
