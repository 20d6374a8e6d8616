"""Find where the float64 numbers of a recorded message stand in its bytes."""

from itertools import islice

import numpy as np
from rclpy.serialization import deserialize_message

from arm_node.workarounds.cdr_layout import LITTLE_ENDIAN, CdrLayout
from arm_node.workarounds.message_fields import float64_fields
from arm_viewer.plots.field_paths import numbers_in, parse_curve, reader
from arm_viewer.recordings.curve import NumberPlace

MAX_BYTES = 20_000
"""Longer messages are pictures, points or maps; nobody plots one of their numbers."""
MAX_NUMBERS = 200
MARK = 2.0**-900
"""Numbers are found by multiples of it, which nothing else in a message is."""


def number_places(data: bytes, message_class: type) -> dict[str, NumberPlace]:
    """Return where each number stands, by its name, such as "position[j0]" or "pose.position.x"."""
    if len(data) > MAX_BYTES or not data.startswith(LITTLE_ENDIAN):
        return {}
    try:
        message = deserialize_message(data, message_class)
    except Exception:
        # rclpy raises any kind of error at bytes that are not a message of the type.
        return {}
    fields = list(float64_fields(message))
    count = 0
    for found in fields:
        found.set_numbers([MARK * (count + n + 1) for n in range(found.size)])
        count += found.size
    layout = CdrLayout(message)
    if not layout.is_known or layout.end > len(data):
        return {}
    offsets = {
        number: layout.begins[found.key] + 8 * n
        for found in fields
        for n, number in enumerate(found.numbers)
    }
    pattern = np.frombuffer(data, dtype=np.uint8)
    is_fixed = np.zeros(len(data), dtype=bool)
    is_fixed[: len(LITTLE_ENDIAN)] = True
    for begin, end in layout.fixed:
        is_fixed[begin:end] = True
    places: dict[str, NumberPlace] = {}
    for path in islice(numbers_in(message), MAX_NUMBERS):
        offset = offsets.get(reader(parse_curve(f"/topic.{path}"))(message))
        if offset is not None:
            places[path] = NumberPlace(offset, pattern, is_fixed)
    return places
