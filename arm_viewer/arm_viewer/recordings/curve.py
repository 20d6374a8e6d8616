"""The curve of a number over a whole recording, without decoding each of its messages.

Where strings and lengths stay the same, as the names of joints do, a number stands at the same
place in every message. Those messages are read with numpy, chunk by chunk; an hour of 500 Hz takes
the time that it takes to unpack it. Messages of another layout are left out and counted.
"""

from collections.abc import Callable, Sequence
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from arm_viewer.recordings.mcap_chunks import MESSAGE_HEADER, RECORD_HEADER, ChunkPlace
from arm_viewer.recordings.recorded_bag import RecordedBag

COLUMNS = 1000
_DATA_OFFSET = RECORD_HEADER.size + MESSAGE_HEADER.size


@dataclass(frozen=True, slots=True, eq=False)
class NumberPlace:
    """Where a float64 stands in messages of one layout.

    Attributes:
        offset: of the number in the message.
        pattern: a message of this layout (n,).
        is_fixed: which of its bytes every message of the layout shares (n,).
    """

    offset: int
    pattern: NDArray[np.uint8]
    is_fixed: NDArray[np.bool_]


@dataclass(frozen=True, slots=True, eq=False)
class WholeCurve:
    """The smallest and largest number in each column of equal length, so that no peak is lost.

    Attributes:
        low: smallest, by column (n,); NaN where no message is.
        high: largest, by column (n,).
        skipped: number of messages of another layout.
    """

    low: NDArray[np.float64]
    high: NDArray[np.float64]
    skipped: int


def read_curve(
    bag: RecordedBag,
    topic: str,
    place: NumberPlace,
    goes_on: Callable[[], bool] = lambda: True,
    length_s: float | None = None,
) -> WholeCurve:
    """Return the curve of a number; what was found so far once `goes_on` returns false.

    It is asked before each chunk. The columns stand for `length_s` from the beginning on, or for
    all there is.

    Raises:
        PageRecordingError: the file is damaged.
    """
    low, high = np.full(COLUMNS, np.inf), np.full(COLUMNS, -np.inf)
    length_ns = max(bag.end_ns - bag.start_ns if length_s is None else round(1e9 * length_s), 1)
    skipped = 0
    for chunk in bag.chunks(topic):
        if not goes_on():
            break
        times_ns, (numbers,), others = _numbers(chunk, [place])
        skipped += others
        passed_ns = times_ns.astype(np.int64) - bag.start_ns
        columns = np.clip(passed_ns * COLUMNS // length_ns, 0, COLUMNS - 1)
        is_number = np.isfinite(numbers)
        columns, numbers = columns[is_number], numbers[is_number]
        np.minimum.at(low, columns, numbers)
        np.maximum.at(high, columns, numbers)
    is_empty = low > high
    low[is_empty] = high[is_empty] = np.nan
    return WholeCurve(low, high, skipped)


def read_samples(
    bag: RecordedBag,
    topic: str,
    places: Sequence[NumberPlace],
    after_ns: int,
    until_ns: int,
) -> tuple[NDArray[np.float64], NDArray[np.float64]]:
    """Return numbers of the messages after a time, up to another one.

    The places are those of k numbers, at least one, in messages of one layout.

    Returns:
        Times in s since 1970 (n,) and numbers (k, n).

    Raises:
        PageRecordingError: the file is damaged.
    """
    times, numbers = [np.empty(0)], [np.empty((len(places), 0))]
    for chunk in bag.chunks(topic):
        if chunk.start_ns <= until_ns and chunk.end_ns > after_ns:
            times_ns, found, _ = _numbers(chunk, places)
            kept = (times_ns > max(after_ns, 0)) & (times_ns <= until_ns)
            times.append(1e-9 * times_ns[kept].astype(np.float64))
            numbers.append(found[:, kept])
    return np.concatenate(times), np.concatenate(numbers, axis=1)


def _numbers(
    chunk: ChunkPlace, places: Sequence[NumberPlace]
) -> tuple[NDArray[np.uint64], NDArray[np.float64], int]:
    """Return times (n,) and numbers (k, n) of messages, and how many have another layout."""
    entries = chunk.entries()
    data = np.frombuffer(chunk.data(), dtype=np.uint8)
    layout = places[0]
    size = len(layout.pattern)
    offsets = entries[:, 1].astype(np.int64)
    fits = offsets + _DATA_OFFSET + size <= len(data)
    records = offsets[fits]
    lengths = _gather(data, records + 1).view("<u8")[:, 0]
    same_size = lengths == MESSAGE_HEADER.size + size
    starts = records[same_size] + _DATA_OFFSET
    times_ns = entries[fits, 0][same_size]
    fixed = np.flatnonzero(layout.is_fixed)
    same = (data[starts[:, None] + fixed] == layout.pattern[fixed]).all(axis=1)
    starts = starts[same]
    numbers = [_gather(data, starts + place.offset).view("<f8")[:, 0] for place in places]
    return times_ns[same], np.array(numbers), len(entries) - len(starts)


def _gather(data: NDArray[np.uint8], starts: NDArray[np.int64]) -> NDArray[np.uint8]:
    """Return eight bytes from each start (n, 8), contiguous."""
    return np.ascontiguousarray(data[starts[:, None] + np.arange(8)])
