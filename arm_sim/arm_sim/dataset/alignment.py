"""Turns streams with uneven stamps into evenly spaced rows of a dataset, and counts the losses.

A row takes the message of the reference that is nearest to its time, and from every other stream
the latest message at or before that message's stamp. Nothing is interpolated. Repeated, unused and
old messages are counted, because a policy learns from them.
"""

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from arm_sim.dataset.streams import Stamps, Stream, check_stream
from arm_sim.errors import CallError

PAUSE_INTERVALS = 5.5
"""A stream pauses where two messages are this many usual intervals apart; the rate ignores it."""
SAME_NS = 100_000
"""A message this little later than its row still belongs to it: LeRobot's own tolerance."""


@dataclass(frozen=True, slots=True)
class StreamUse:
    """How the rows use one stream.

    Attributes:
        name: the feature.
        messages: messages from the first row to the last.
        repeated: rows with the same message as the row before.
        left_out: messages that are in no row.
        oldest_s: largest age of a message in its row.
    """

    name: str
    messages: int
    repeated: int
    left_out: int
    oldest_s: float

    @property
    def is_exact(self) -> bool:
        """Whether each row has its own message at its time, and no message is left out."""
        return not (self.repeated or self.left_out or self.oldest_s * 1e9 > SAME_NS)

    def __str__(self) -> str:
        if self.is_exact:
            return f"{self.name}: {self.messages} messages, one in each row"
        return (
            f"{self.name}: {self.messages} messages, {self.left_out} in no row; {self.repeated} "
            f"rows repeat a message; up to {self.oldest_s * 1e3:.1f} ms old"
        )


@dataclass(frozen=True, slots=True)
class Alignment:
    """The rows of one episode.

    Attributes:
        fps: rows per second.
        start_ns: time of the first row.
        rows: for each stream, the index of its message in each row, shape (rows,).
        uses: how the rows use each stream.
        jitter_s: largest distance in time of a reference message from row k, which is k / fps after
            row 0. It is not 0 for a camera, whose frames are taken at control periods.
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

    The first row is at the first message of the reference by which every stream has begun; the last
    row is at or before the last message of the reference.

    Args:
        streams: the streams of one episode.
        reference: index of the stream whose messages determine the first and the last row.
        fps: rows per second; None for the rate of the reference.

    Raises:
        CallError: a stream is invalid, or the streams do not overlap in time.
    """
    for stream in streams:
        check_stream(stream)
    own = streams[reference].stamps_ns
    fps = rate_of(streams[reference].name, own) if fps is None else fps
    if fps < 1:
        raise CallError(f"a dataset needs at least 1 row per second, not {fps}")
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
    """Return the rate of a stream, rounded to whole messages per second.

    Raises:
        CallError: it has only one message, or less than one per second.
    """
    if len(stamps_ns) < 2:
        raise CallError(f"{name} has only one message, so it has no rate; give --fps")
    intervals = np.diff(stamps_ns)
    # A camera takes its frames at control periods: at 30 Hz they are 40, 30 and 30 ms apart. An
    # interval of about two or more usual ones means lost messages; a much longer one is a pause.
    usual = float(np.median(intervals))
    running = intervals[intervals < PAUSE_INTERVALS * usual]
    rate = 1e9 * float(np.round(running / usual).sum() / running.sum())
    if round(rate) < 1:
        raise CallError(f"{name} has {rate:.3g} messages per second; give --fps")
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
