"""Rows of a dataset, which are equally far apart, from streams that are not; and what that costs.

A row takes the nearest message of the reference, and of each other stream the latest at or before
that one's stamp. Nothing is interpolated. What is repeated, left out or old is counted, because a
policy learns it.
"""

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from arm_sim.dataset.streams import Stamps, Stream, check_stream
from arm_sim.errors import CallError

PAUSE = 5.5
"""An interval of so many usual ones says nothing about the rate."""
SAME_NS = 100_000
"""A message that is later than its row by this little belongs to it: LeRobot's own tolerance."""


@dataclass(frozen=True, slots=True)
class StreamUse:
    """How the rows use one stream.

    Attributes:
        name: the feature.
        messages: messages from the first row to the last.
        repeated: rows that have the message of the row before.
        left_out: messages that no row has.
        oldest_s: largest age of a message in its row.
    """

    name: str
    messages: int
    repeated: int
    left_out: int
    oldest_s: float

    @property
    def is_exact(self) -> bool:
        """Whether each row has a message of its own at its time, and none is left out."""
        return not (self.repeated or self.left_out or self.oldest_s * 1e9 > SAME_NS)

    def __str__(self) -> str:
        if self.is_exact:
            return f"{self.name}: {self.messages} messages, one in each row"
        return (
            f"{self.name}: {self.messages} messages, {self.left_out} in no row; {self.repeated} "
            f"rows repeat one; up to {self.oldest_s * 1e3:.1f} ms old"
        )


@dataclass(frozen=True, slots=True)
class Alignment:
    """The rows of one episode.

    Attributes:
        fps: rows a second.
        start_ns: time of the first row.
        rows: for each stream, the index of its message in each row, shape (rows,).
        uses: how the rows use each stream.
        jitter_s: largest distance of a message of the reference from its row's time, which is
            k / fps after the first; the stamps of a camera are those of control periods.
    """

    fps: int
    start_ns: int
    rows: tuple[NDArray[np.int64], ...]
    uses: tuple[StreamUse, ...]
    jitter_s: float

    @property
    def length(self) -> int:
        """Number of rows."""
        return len(self.rows[0])


def align(streams: Sequence[Stream], reference: int, fps: int | None = None) -> Alignment:
    """Return the rows of streams.

    The first row is at the first message of the reference from which on every stream has one; the
    last is at or before the last message of the reference.

    Args:
        streams: the streams of one episode.
        reference: index of the stream whose messages begin and end the rows.
        fps: rows a second; None for the rate of the reference.

    Raises:
        CallError: a stream is wrong, or no time has all of them.
    """
    for stream in streams:
        check_stream(stream)
    own = streams[reference].stamps_ns
    fps = rate_of(streams[reference].name, own) if fps is None else fps
    if fps < 1:
        raise CallError(f"a dataset has at least 1 row a second, not {fps}")
    common = max(int(stream.stamps_ns[0]) for stream in streams)
    at_start = own[own >= common - SAME_NS]
    if not len(at_start):
        late = max(streams, key=lambda stream: int(stream.stamps_ns[0]))
        raise CallError(
            f"{late.name} begins after the last message of {streams[reference].name}, so no row "
            "has both"
        )
    start = int(at_start[0])
    count = (int(own[-1]) - start + round(0.5 * 1e9 / fps)) * fps // 1_000_000_000 + 1
    nominal = start + np.round(np.arange(count) * (1e9 / fps)).astype(np.int64)
    nearest = _nearest(own, nominal)
    distance = np.abs(own[nearest] - nominal)
    has_own = distance <= 0.5 * 1e9 / fps
    times = np.where(has_own, own[nearest], nominal)
    rows = tuple(
        np.searchsorted(stream.stamps_ns, times + SAME_NS, side="right") - 1 for stream in streams
    )
    uses = tuple(_use(stream, row, times) for stream, row in zip(streams, rows, strict=True))
    return Alignment(fps, start, rows, uses, float(distance[has_own].max(initial=0)) * 1e-9)


def _nearest(stamps_ns: Stamps, times: Stamps) -> NDArray[np.int64]:
    """Return the indices of the stamps that are nearest to times; of two, the earlier."""
    after = np.clip(np.searchsorted(stamps_ns, times), 1, max(1, len(stamps_ns) - 1))
    before = after - 1
    after = np.minimum(after, len(stamps_ns) - 1)
    return np.where(stamps_ns[after] - times < times - stamps_ns[before], after, before)


def rate_of(name: str, stamps_ns: Stamps) -> int:
    """Return the rate of a stream in whole messages a second.

    Raises:
        CallError: it has one message only, or fewer than one a second.
    """
    if len(stamps_ns) < 2:
        raise CallError(f"{name} has one message only, which has no rate; give --fps")
    intervals = np.diff(stamps_ns)
    # Frames of a camera are those of control periods: 30 a second are 40, 30, 30 ms apart. An
    # interval of two or more is that of lost messages; a longer one is a pause.
    usual = float(np.median(intervals))
    running = intervals[intervals < PAUSE * usual]
    rate = 1e9 * float(np.round(running / usual).sum() / running.sum())
    if round(rate) < 1:
        raise CallError(f"{name} has {rate:.3g} messages a second; give --fps")
    return round(rate)


def _use(stream: Stream, rows: NDArray[np.int64], times: Stamps) -> StreamUse:
    used = np.unique(rows)
    ages = times - stream.stamps_ns[rows]
    between = int(rows[-1] - rows[0] + 1)
    return StreamUse(
        name=stream.name,
        messages=between,
        repeated=len(rows) - len(used),
        left_out=between - len(used),
        oldest_s=max(0.0, float(ages.max()) * 1e-9),
    )
