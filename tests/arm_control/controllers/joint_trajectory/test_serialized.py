"""Trajectories read from their bytes: whatever fields the points have, and however they lie."""

import struct
from collections.abc import Sequence
from contextlib import suppress

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from arm_control.controllers.joint_trajectory.serialized import (
    SerializedTrajectoryError,
    read_trajectory,
)
from arm_control.controllers.joint_trajectory.trajectory import FIELDS, TrajectoryPoint, WayPoints


class Writer:
    """Serialises as CDR says: each number at a multiple of its size."""

    def __init__(self, order: str) -> None:
        self._order = order
        self._body = b""

    def number(self, kind: str, value: float) -> None:
        self._body += bytes(-len(self._body) % struct.calcsize(kind))
        self._body += struct.pack(f"{self._order}{kind}", value)

    def text(self, text: str) -> None:
        data = text.encode() + b"\0"
        self.number("I", len(data))
        self._body += data

    @property
    def data(self) -> bytes:
        return (b"\0\1\0\0" if self._order == "<" else b"\0\0\0\0") + self._body


def serialize(
    names: Sequence[str], points: Sequence[TrajectoryPoint], frame: str = "", order: str = "<"
) -> bytes:
    """Return a JointTrajectory, stamped 3.25 s, whose times are whole milliseconds."""
    writer = Writer(order)
    writer.number("i", 3)
    writer.number("I", 250_000_000)
    writer.text(frame)
    writer.number("I", len(names))
    for name in names:
        writer.text(name)
    writer.number("I", len(points))
    for point in points:
        for field in FIELDS:
            values = getattr(point, field)
            writer.number("I", len(values))
            for value in values:
                writer.number("d", value)
        seconds, milliseconds = divmod(round(1e3 * point.time_from_start_s), 1000)
        writer.number("i", seconds)
        writer.number("I", milliseconds * 1_000_000)
    return writer.data


numbers = st.lists(st.floats(-9, 9, width=32), max_size=3)
times = st.integers(-5000, 5000).map(lambda milliseconds: milliseconds / 1000)
any_point = st.builds(TrajectoryPoint, times, numbers, numbers, numbers, numbers)


@st.composite
def like_points(draw: st.DrawFn) -> list[TrajectoryPoint]:
    """Draw points that all have the same fields."""
    sizes = draw(st.tuples(*[st.integers(0, 3)] * 4))
    count = draw(st.integers(0, 9))
    values = np.arange(count * sum(sizes), dtype=np.float64)
    ends = np.cumsum(sizes)
    return [
        TrajectoryPoint(0.5 * i, *(part.tolist() for part in np.split(row, ends[:-1])))
        for i, row in enumerate(values.reshape(count, sum(sizes)))
    ]


@given(
    names=st.lists(st.text("abc_", max_size=6), max_size=4),
    points=st.one_of(like_points(), st.lists(any_point, max_size=6)),
    frame=st.text("xyz", max_size=9),
    order=st.sampled_from("<>"),
)
def test_what_was_written_is_read(names, points, frame, order):
    request = read_trajectory(serialize(names, points, frame, order))
    assert (list(request.joint_names), request.stamp_s) == (names, 3.25)
    assert len(request.points) == len(points)
    for read, written in zip(request.points, points, strict=True):
        assert read.time_from_start_s == pytest.approx(written.time_from_start_s, abs=1e-9)
        for field in FIELDS:
            assert list(getattr(read, field)) == list(getattr(written, field))


@given(points=st.lists(any_point, max_size=6))
def test_points_are_the_same_as_arrays(points):
    kept = WayPoints.of(points)
    assert list(kept) == points
    assert kept[1:] == points[1:]
    assert kept.sizes.tolist() == [[len(getattr(p, field)) for field in FIELDS] for p in points]


@given(points=st.one_of(like_points(), st.lists(any_point, max_size=6)), data=st.data())
def test_bytes_that_end_too_soon_are_refused(points, data):
    whole = serialize(["j0", "j1"], points)
    kept = data.draw(st.integers(0, len(whole) - 1))
    with pytest.raises(SerializedTrajectoryError):
        read_trajectory(whole[:kept])


def test_the_last_of_many_points_is_not_read_beyond_the_end():
    points = [TrajectoryPoint(0.5 * i, [float(i)] * 3) for i in range(20)]
    whole = serialize(["j0", "j1", "j2"], points)
    for kept in range(len(whole) - 60, len(whole)):
        with pytest.raises(SerializedTrajectoryError, match="are incomplete or damaged"):
            read_trajectory(whole[:kept])


@given(st.binary(max_size=200))
def test_any_other_bytes_are_refused_or_read(data):
    with suppress(SerializedTrajectoryError):
        assert len(read_trajectory(b"\0\1\0\0" + data).points) <= len(data) / 24


def test_a_count_beyond_the_bytes_takes_no_memory():
    count_at = len(serialize([], [])) - 4
    data = serialize([], [])[:count_at] + struct.pack("<I", 2**31) + bytes(100)
    with pytest.raises(SerializedTrajectoryError, match="2147483648 elements in 100 bytes"):
        read_trajectory(data)


def test_another_encoding_is_named():
    with pytest.raises(SerializedTrajectoryError, match="the encoding 000b is not plain CDR"):
        read_trajectory(b"\0\x0b\0\0" + bytes(40))
