"""Where the parts of a message stand in its bytes, and where the message ends.

The bytes are plain CDR as ROS 2 writes it: OMG DDS-XTypes 1.3, section 7.4.1, XCDR version 1. A
number begins at a multiple of its own size. In the gaps before numbers, and in up to a few dozen
bytes behind the last one, rclpy's `serialize_message` leaves whatever its memory held; seen in
rclpy 7.1 and 9.1. Readers that look at the length, as rosbags does, refuse a message with such an
end.
"""

import re
from typing import Any

HEADER_BYTES = 4
"""The header of the encoding; alignment is counted from its end."""
LITTLE_ENDIAN = b"\x00\x01"
"""What the header of this encoding begins with."""

_ARRAY = re.compile(r"(?P<is_long>sequence)<([^,>]+)(?:, \d+)?>|([^\[]+)\[\d+\]")
_SIZES = {"boolean": 1, "octet": 1, "float": 4, "double": 8} | {
    f"{sign}int{bits}": bits // 8 for sign in ("", "u") for bits in (8, 16, 32, 64)
}


class CdrLayout:
    """Where the parts of a message stand. It needs no ROS: a message is whatever lists its fields.

    Attributes:
        begins: offset of the first number of each field of numbers, by the `id` of the message that
            has the field and the field's name; the field's other numbers follow without a gap.
        fixed: begin and end of each text and each length.
        end: number of bytes.
        is_known: whether it has only parts whose size is known: all but wide text.
    """

    def __init__(self, message: Any) -> None:
        """Walk through all its fields."""
        self.begins: dict[tuple[int, str], int] = {}
        self.fixed: list[tuple[int, int]] = []
        self.end = HEADER_BYTES
        self.is_known = True
        self._add_message(message)

    def _add_message(self, message: Any) -> None:
        fields = message.get_fields_and_field_types()
        for name, kind in fields.items():
            values: Any = [getattr(message, name)]
            if array := _ARRAY.fullmatch(kind):
                (values,), kind = values, array[2] or array[3]
                if array["is_long"]:
                    self._add_length()
            if kind in _SIZES:
                self.begins[id(message), name] = self._add_numbers(len(values), _SIZES[kind])
            else:
                for value in values:
                    self._add(value, kind)
        if not fields:
            self._add_numbers(1, 1)

    def _add(self, value: Any, kind: str) -> None:
        """Add a message or a text."""
        if "/" in kind:
            self._add_message(value)
        elif kind.startswith("string"):
            self._add_length()
            begin, self.end = self.end, self.end + len(value.encode()) + 1
            self.fixed.append((begin, self.end))
        else:
            self.is_known = False

    def _add_length(self) -> None:
        self.fixed.append((self._add_numbers(1, 4), self.end))

    def _add_numbers(self, count: int, size: int) -> int:
        """Add numbers of this many bytes each, and return where they begin."""
        if not count:
            return self.end
        begin = self.end + (HEADER_BYTES - self.end) % size
        self.end = begin + count * size
        return begin
