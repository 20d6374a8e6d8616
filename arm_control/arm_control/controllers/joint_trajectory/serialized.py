"""Reads a serialised trajectory_msgs/msg/JointTrajectory without deserialising the message.

While rclpy creates a message, no other Python thread runs: with 100,000 waypoints that takes most
of a second, in which a control loop stands still. NumPy reads the same bytes in some milliseconds,
because waypoints with the same fields are evenly spaced.

The encoding is CDR: every number is aligned to its own size, counted from the end of the four-byte
header.
"""

import struct
from collections.abc import Iterator
from typing import Any, NamedTuple

import numpy as np
from numpy.typing import NDArray

from arm_control.controllers.joint_trajectory.trajectory import FIELDS, TrajectoryRequest, WayPoints
from arm_control.errors import ArmControlError

HEADER_BYTES = 4
BYTE_ORDERS = {b"\x00\x00": ">", b"\x00\x01": "<"}
"""By the first half of the header: plain CDR, big-endian or little-endian."""
NUMBER_BYTES = 8
SMALLEST_POINT_BYTES = 24
"""Four empty sequences and a time."""


class SerializedTrajectoryError(ArmControlError):
    """The bytes are not a trajectory; the message says why."""


class _PointLayout(NamedTuple):
    """The layout of a waypoint; offsets count from the end of the header.

    Attributes:
        sizes: how many numbers each field has.
        size_at: offset of each field's size.
        numbers_at: offset of each field's numbers.
        time_at: offset of the time.
        end: offset of the end.
    """

    sizes: tuple[int, ...]
    size_at: tuple[int, ...]
    numbers_at: tuple[int, ...]
    time_at: int
    end: int


def read_trajectory(data: bytes) -> TrajectoryRequest:
    """Return the trajectory in a serialised message.

    Raises:
        SerializedTrajectoryError: the bytes are something else, or incomplete.
    """
    order = BYTE_ORDERS.get(bytes(data[:2]))
    if order is None:
        raise SerializedTrajectoryError(f"the encoding {bytes(data[:2]).hex()} is not plain CDR")
    reader = _Reader(memoryview(data)[HEADER_BYTES:], order)
    try:
        return reader.trajectory()
    except (struct.error, TypeError, ValueError) as error:
        raise SerializedTrajectoryError(
            f"the {len(data)} bytes of a trajectory are incomplete or damaged: {error}"
        ) from error


class _Reader:
    """Reads one message from front to back."""

    def __init__(self, body: memoryview, order: str) -> None:
        self._body = body
        self._order = order
        self._at = 0

    def trajectory(self) -> TrajectoryRequest:
        seconds, nanoseconds = self._numbers("iI")
        self._text()
        names = [self._text() for _ in range(self._count(HEADER_BYTES))]
        count = self._count(SMALLEST_POINT_BYTES)
        return TrajectoryRequest(names, self._points(count), seconds + nanoseconds * 1e-9)

    def _points(self, count: int) -> WayPoints:
        """Read all waypoints: together if they have the same fields, otherwise one by one."""
        if count == 0:
            return WayPoints.of(())
        return self._uniform(count) or self._one_by_one(count)

    def _uniform(self, count: int) -> WayPoints | None:
        """Read points that all have the same fields; return None if they do not.

        Each point is aligned to four bytes, its numbers to eight. So after the first point, the
        distance between points is constant, or alternates between two values.
        """
        first = self._layout(self._at)
        least_bytes = SMALLEST_POINT_BYTES + NUMBER_BYTES * sum(first.sizes)
        if count * least_bytes > len(self._body) - self._at:
            return None  # The sizes may be wrong, so do not allocate memory for all points.
        layouts = [first]
        while len(layouts) < min(count, 3):
            layouts.append(self._layout(layouts[-1].end))
        if any(layout.sizes != first.sizes for layout in layouts):
            return None
        times_s = np.empty(count)
        numbers = [np.empty((count, size)) for size in first.sizes]
        self._fill(times_s, numbers, slice(0, 1), first, 0)
        if count > 1:
            alternates = count > 2 and (layouts[2].end - layouts[1].end) != (
                layouts[1].end - first.end
            )
            turn = 2 if alternates else 1
            stride = layouts[turn].end - layouts[0].end
            for phase in range(turn):
                places = slice(1 + phase, count, turn)
                if not self._fill(times_s, numbers, places, layouts[1 + phase], stride):
                    return None
        sizes = np.tile(np.array(first.sizes, dtype=np.intp), (count, 1))
        return WayPoints(times_s, sizes, [field.ravel() for field in numbers])

    def _fill(
        self,
        times_s: NDArray[np.float64],
        numbers: list[NDArray[np.float64]],
        places: slice,
        layout: _PointLayout,
        stride: int,
    ) -> bool:
        """Read evenly spaced points, the first of which has this layout, into the arrays.

        Returns:
            Whether all of them have the same fields.
        """
        count = len(times_s[places])
        for field, size in enumerate(layout.sizes):
            if not (self._strided("u4", count, layout.size_at[field], stride) == size).all():
                return False
            if size:
                numbers[field][places] = self._strided(
                    "f8", count, layout.numbers_at[field], stride, size
                )
        seconds = self._strided("i4", count, layout.time_at, stride)
        nanoseconds = self._strided("u4", count, layout.time_at + 4, stride)
        times_s[places] = seconds + nanoseconds * 1e-9
        return True

    def _one_by_one(self, count: int) -> WayPoints:
        times_s, sizes = np.empty(count), np.empty((count, len(FIELDS)), dtype=np.intp)
        parts: list[list[NDArray[np.float64]]] = [[] for _ in FIELDS]
        for i, layout in enumerate(self._layouts(count)):
            sizes[i] = layout.sizes
            seconds, nanoseconds = struct.unpack_from(
                f"{self._order}iI", self._body, layout.time_at
            )
            times_s[i] = seconds + nanoseconds * 1e-9
            for part, at, size in zip(parts, layout.numbers_at, layout.sizes, strict=True):
                if size:
                    part.append(self._strided("f8", 1, at, 0, size)[0])
        return WayPoints(
            times_s, sizes, [np.concatenate(part) if part else np.empty(0) for part in parts]
        )

    def _layouts(self, count: int) -> Iterator[_PointLayout]:
        at = self._at
        for _ in range(count):
            layout = self._layout(at)
            yield layout
            at = layout.end

    def _layout(self, at: int) -> _PointLayout:
        """Return the layout of the point at an offset, which is a multiple of four."""
        sizes, size_at, numbers_at = [], [], []
        for _ in FIELDS:
            (size,) = struct.unpack_from(f"{self._order}I", self._body, at)
            size_at.append(at)
            at += 4
            if size:
                at = _aligned(at, NUMBER_BYTES)
            numbers_at.append(at)
            sizes.append(size)
            at += NUMBER_BYTES * size
        end = at + 8
        if end > len(self._body):
            raise ValueError(f"a waypoint ends at byte {end} of {len(self._body)}")
        return _PointLayout(tuple(sizes), tuple(size_at), tuple(numbers_at), at, end)

    def _strided(
        self, kind: str, count: int, at: int, stride: int, columns: int = 0
    ) -> NDArray[Any]:
        """Return a view of evenly spaced numbers, shape (count,) or (count, columns).

        Raises:
            ValueError: the last of them would be beyond the end.
        """
        dtype = np.dtype(f"{self._order}{kind}")
        shape = (count, columns) if columns else (count,)
        strides = (stride, dtype.itemsize) if columns else (stride,)
        return np.ndarray(shape, dtype, buffer=self._body, offset=at, strides=strides)

    def _numbers(self, kinds: str) -> tuple[int, ...]:
        """Read numbers of four bytes."""
        self._at = _aligned(self._at, 4)
        values = struct.unpack_from(f"{self._order}{kinds}", self._body, self._at)
        self._at += 4 * len(kinds)
        return values

    def _count(self, smallest_bytes: int) -> int:
        """Read the number of elements, each of which takes at least `smallest_bytes`."""
        (count,) = self._numbers("I")
        if count * smallest_bytes > len(self._body) - self._at:
            raise ValueError(f"{count} elements in {len(self._body) - self._at} bytes")
        return count

    def _text(self) -> str:
        """Read a string; its length includes the terminating zero."""
        length = self._count(1)
        text = bytes(self._body[self._at : self._at + length])
        self._at += length
        return text[:-1].decode(errors="replace")


def _aligned(at: int, size: int) -> int:
    return -(-at // size) * size
