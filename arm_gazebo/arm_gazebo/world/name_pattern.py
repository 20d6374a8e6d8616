"""Regular expressions that are found, or not, in a time that no pattern can blow up.

`re` tries the ways in which a pattern may fit one after the other. There may be 2 to the power of
the name's length, and it keeps all other threads waiting meanwhile, the control loop among them.
Here all ways are followed at once: what counts is only where they end, and there are no more ends
than letters.
"""

import re
from dataclasses import dataclass
from typing import Protocol

from arm_gazebo.world.refusal import Refusal, RefusedError

LONGEST_PATTERN = 200
CLASSES = {
    "alpha": "a-zA-Z",
    "digit": "0-9",
    "alnum": "a-zA-Z0-9",
    "upper": "A-Z",
    "lower": "a-z",
    "xdigit": "0-9A-Fa-f",
    "space": r"\s",
    "blank": r" \t",
    "punct": r"!-/:-@\[-`{-~",
}
"""POSIX's names of letters in brackets, as in [[:alpha:]_], in the words of `re`."""

# A letter, letters in brackets, or an assertion such as ^: nothing that may fit in many ways.
_ITEM = re.compile(r"\\.|\[\^?\]?(?:\\.|\[:\w*:\]|[^]\\])*\]|[^][\\(){}|*+?]", re.DOTALL)
_CLASS = re.compile(r"\[:(\w*):\]")
# The last question mark asks for the shortest fit, which is found where any is.
_TIMES = re.compile(r"(?:([*+?])|\{([0-9]{0,9})(,?)([0-9]{0,9})\})\??")
_RANGES = {"*": (0, None), "+": (1, None), "?": (0, 1)}


class NamePattern:
    """A POSIX extended regular expression, which may have the escapes of `re`, too.

    Raises:
        RefusedError: it is none, or longer than `LONGEST_PATTERN`.
    """

    def __init__(self, pattern: str) -> None:
        if len(pattern) > LONGEST_PATTERN:
            raise RefusedError(
                Refusal.FAILED, f"the filter has more than {LONGEST_PATTERN} characters"
            )
        self._part = _Reader(pattern).read()

    def is_in(self, name: str) -> bool:
        """Return whether the pattern fits some part of a name."""
        return _Walk(name).ends_of_all(self._part, (2 << len(name)) - 1) != 0


class _Part(Protocol):
    def ends(self, walk: "_Walk", place: int) -> int:
        """Return where this may end if it starts at a place: a number with those bits set."""
        ...


class _Walk:
    """Where the parts of a pattern may end in one name; each is found out once."""

    def __init__(self, name: str) -> None:
        self.name = name
        self._known: dict[tuple[_Part, int], int] = {}

    def ends_of_all(self, part: _Part, places: int) -> int:
        """Return where a part may end that starts at one of these places, bits both."""
        ends = 0
        while places:
            place = places.bit_length() - 1
            places ^= 1 << place
            if (part, place) not in self._known:
                self._known[part, place] = part.ends(self, place)
            ends |= self._known[part, place]
        return ends


@dataclass(frozen=True, slots=True, eq=False)
class _Item:
    expression: re.Pattern[str]

    def ends(self, walk: _Walk, place: int) -> int:
        found = self.expression.match(walk.name, place)
        return 0 if found is None else 1 << found.end()


@dataclass(frozen=True, slots=True, eq=False)
class _Row:
    parts: tuple[_Part, ...]

    def ends(self, walk: _Walk, place: int) -> int:
        places = 1 << place
        for part in self.parts:
            places = walk.ends_of_all(part, places)
        return places


@dataclass(frozen=True, slots=True, eq=False)
class _Choice:
    parts: tuple[_Part, ...]

    def ends(self, walk: _Walk, place: int) -> int:
        ends = 0
        for part in self.parts:
            ends |= walk.ends_of_all(part, 1 << place)
        return ends


@dataclass(frozen=True, slots=True, eq=False)
class _Repeat:
    part: _Part
    least: int
    most: int | None

    def ends(self, walk: _Walk, place: int) -> int:
        places = 1 << place
        for _ in range(self.least):
            before, places = places, walk.ends_of_all(self.part, places)
            if places == before:
                break
        ends, further = places, 0
        while places and (self.most is None or further < self.most - self.least):
            places = walk.ends_of_all(self.part, places) & ~ends
            ends |= places
            further += 1
        return ends


class _Reader:
    """Reads a pattern from its start to its end."""

    def __init__(self, pattern: str) -> None:
        self._pattern = pattern
        self._at = 0

    def read(self) -> _Part:
        try:
            part = self._choice()
        except (re.error, RecursionError) as error:
            raise self._refused(str(error)) from error
        if self._at < len(self._pattern):
            raise self._refused(f"a {self._pattern[self._at]!r} stands alone")
        return part

    def _choice(self) -> _Part:
        rows = [self._row()]
        while self._take("|"):
            rows.append(self._row())
        return rows[0] if len(rows) == 1 else _Choice(tuple(rows))

    def _row(self) -> _Part:
        parts: list[_Part] = []
        while (part := self._one()) is not None:
            times = _TIMES.match(self._pattern, self._at)
            if times is not None:
                self._at = times.end()
                part = _Repeat(part, *self._range(times))
            parts.append(part)
        return parts[0] if len(parts) == 1 else _Row(tuple(parts))

    def _one(self) -> _Part | None:
        """Read a group or an item; None where the row ends."""
        if self._take("("):
            if self._take("?") and not self._take(":"):
                raise self._refused("'(?' starts nothing that POSIX has")
            part = self._choice()
            if not self._take(")"):
                raise self._refused("a '(' is not closed")
            return part
        item = _ITEM.match(self._pattern, self._at)
        if item is None:
            return None
        self._at = item.end()
        text = item.group()
        return _Item(re.compile(_CLASS.sub(self._letters, text) if text[0] == "[" else text))

    def _letters(self, named: re.Match[str]) -> str:
        if named[1] not in CLASSES:
            raise self._refused(f"no class {named[0]}; there are {', '.join(CLASSES)}")
        return CLASSES[named[1]]

    def _range(self, times: re.Match[str]) -> tuple[int, int | None]:
        sign, least, comma, most = times.groups()
        if sign:
            return _RANGES[sign]
        if not (least or most):
            raise self._refused("braces take one number, or two with a comma between them")
        low = int(least or 0)
        high = (int(most) if most else None) if comma else low
        if high is not None and high < low:
            raise self._refused(f"{times[0]} is upside down")
        return low, high

    def _take(self, sign: str) -> bool:
        found = self._pattern.startswith(sign, self._at)
        self._at += len(sign) * found
        return found

    def _refused(self, reason: str) -> RefusedError:
        return RefusedError(
            Refusal.FAILED, f"the filter {self._pattern!r} is no regular expression: {reason}"
        )
