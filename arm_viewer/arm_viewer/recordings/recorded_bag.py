"""A recording: what each topic said at a time.

Each topic is asked by itself, through the index of the file: one pass back over all of them would
read an hour of joint states to find the robot description at its beginning.
"""

import heapq
from collections.abc import Iterable, Iterator, Sequence
from contextlib import ExitStack, closing
from dataclasses import dataclass
from pathlib import Path

import numpy as np

from arm_viewer.errors import PageRecordingError
from arm_viewer.recordings.mcap_chunks import (
    MESSAGE_HEADER,
    RECORD_HEADER,
    ChunkPlace,
    McapChunks,
)

CDR = "cdr"
SUFFIX = ".mcap"
_DATA_OFFSET = RECORD_HEADER.size + MESSAGE_HEADER.size


@dataclass(frozen=True, slots=True)
class Sample:
    """A message as it was recorded: when it arrived, and its bytes."""

    time_ns: int
    data: bytes


@dataclass(frozen=True, slots=True)
class TopicSummary:
    """A topic of a recording.

    Attributes:
        type: such as "sensor_msgs/msg/JointState"; empty if the topic has several.
        count: number of its messages.
        encoding: how they are serialised; ROS 2 has "cdr".
    """

    name: str
    type: str
    count: int
    encoding: str


class RecordedBag:
    """Reads a bag: a folder with MCAP files, or one file. One thread at a time.

    Attributes:
        path: the folder or file.
        topics: the topics that have messages, by name.
        start_ns: time of the first message.
        end_ns: time of the last message.
    """

    def __init__(self, path: Path, files: Sequence[Path] = ()) -> None:
        """Open it.

        Args:
            path: the folder or file.
            files: its files, where there will be more; without them, all that are there.

        Raises:
            PageRecordingError: there is no recording, or it cannot be read; the message says why.
        """
        self.path = path
        self._files: dict[Path, McapChunks] = {}
        with ExitStack() as opening:
            self._open_files = opening
            self._open(files or _files(path))
            if not self.topics:
                raise PageRecordingError(f"{path} has no messages")
            self._open_files = opening.pop_all()

    def extend(self, files: Sequence[Path]) -> bool:
        """Read these files, too; return whether one of them is new.

        Raises:
            PageRecordingError: one of them cannot be read.
        """
        if self._files.keys() >= set(files):
            return False
        self._open(files)
        return True

    def _open(self, paths: Sequence[Path]) -> None:
        """Open the files that are not open, and find the messages of all of them."""
        for path in paths:
            if path not in self._files:
                self._files[path] = self._open_files.enter_context(closing(McapChunks(path)))
        files = self._files.values()
        self.topics = _topics(files)
        statistics = [s for s in (file.summary.statistics for file in files) if s]
        filled = [s for s in statistics if s.message_count]
        self.start_ns = min((s.message_start_time for s in filled), default=0)
        self.end_ns = max((s.message_end_time for s in filled), default=0)
        self._places: dict[str, list[ChunkPlace]] = {name: [] for name in self.topics}
        for file in files:
            for channel in file.summary.channels.values():
                self._places.get(channel.topic, []).extend(file.places(channel))
        for places in self._places.values():
            places.sort(key=lambda place: place.start_ns)
        self._starts = {n: [place.start_ns for place in p] for n, p in self._places.items()}
        # The latest end of a chunk and of all before it: chunks may overlap.
        self._ends = {
            name: np.maximum.accumulate([place.end_ns for place in places] or [0]).tolist()
            for name, places in self._places.items()
        }
        self._last: dict[str, tuple[int, int, Sample | None]] = {}

    def close(self) -> None:
        """Close the files."""
        self._open_files.close()

    def last(self, topic: str, time_ns: int) -> Sample | None:
        """Return the last message of a topic at or before a time, None if there is none.

        It is the same object as long as it stays the last one.

        Raises:
            PageRecordingError: the file is damaged.
        """
        known = self._last.get(topic)
        if known is None or not known[0] <= time_ns < known[1]:
            sample = next(self.backwards(topic, time_ns), None)
            from_ns = self.start_ns if sample is None else sample.time_ns
            known = self._last[topic] = (from_ns, self._next_ns(topic, time_ns), sample)
        return known[2]

    def backwards(self, topic: str, time_ns: int) -> Iterator[Sample]:
        """Yield the messages of a topic at or before a time, the latest first.

        Raises:
            PageRecordingError: the file is damaged.
        """
        places, ends = self._places.get(topic, []), self._ends.get(topic, [])
        unread = int(np.searchsorted(self._starts.get(topic, []), time_ns, side="right"))
        # By time: the latest message of each chunk that has been looked into.
        waiting: list[tuple[int, int, int]] = []
        while waiting or unread:
            while unread and (not waiting or ends[unread - 1] >= -waiting[0][0]):
                unread -= 1
                entries = places[unread].entries()
                row = int(np.searchsorted(entries[:, 0], time_ns, side="right")) - 1
                if row >= 0:
                    heapq.heappush(waiting, (-int(entries[row, 0]), -unread, row))
            if not waiting:
                return
            minus_ns, minus_number, row = waiting[0]
            place = places[-minus_number]
            yield Sample(-minus_ns, _message(place, row))
            if row:
                earlier = (-int(place.entries()[row - 1, 0]), minus_number, row - 1)
                heapq.heapreplace(waiting, earlier)
            else:
                heapq.heappop(waiting)

    def chunks(self, topic: str) -> Iterator[ChunkPlace]:
        """Yield the chunks with messages of a topic, by the time at which they start."""
        yield from self._places.get(topic, [])

    def _next_ns(self, topic: str, time_ns: int) -> int:
        """Return a time until which no message of a topic comes after this one."""
        places = self._places.get(topic, [])
        first_later = int(np.searchsorted(self._starts.get(topic, []), time_ns, side="right"))
        found = [places[first_later].start_ns] if first_later < len(places) else []
        ends = self._ends.get(topic, [])
        for number in range(first_later - 1, -1, -1):
            if ends[number] <= time_ns:
                break
            times_ns = places[number].entries()[:, 0]
            row = int(np.searchsorted(times_ns, time_ns, side="right"))
            if row < len(times_ns):
                found.append(int(times_ns[row]))
        return min(found, default=self.end_ns + 1_000_000_000_000_000)


def _message(place: ChunkPlace, row: int) -> bytes:
    data, offset = place.data(), int(place.entries()[row, 1])
    if offset + _DATA_OFFSET > len(data):
        raise PageRecordingError(
            f"{place.file.path} cannot be read: its index leads outside a chunk"
        )
    _, length = RECORD_HEADER.unpack_from(data, offset)
    return data[offset + _DATA_OFFSET : offset + RECORD_HEADER.size + length]


def _files(path: Path) -> list[Path]:
    if path.is_dir():
        found = sorted(path.glob(f"*{SUFFIX}"))
        if not found:
            raise PageRecordingError(f"the folder {path} holds no {SUFFIX} file")
        return found
    if not path.exists():
        raise PageRecordingError(f"there is no recording {path}")
    if path.suffix != SUFFIX:
        raise PageRecordingError(f"{path} is not an {SUFFIX} file or a folder with such files")
    return [path]


def _topics(files: Iterable[McapChunks]) -> dict[str, TopicSummary]:
    found: dict[str, TopicSummary] = {}
    for summary in (file.summary for file in files):
        counts = summary.statistics.channel_message_counts if summary.statistics else {}
        for channel in summary.channels.values():
            count = counts.get(channel.id, 0)
            if not count:
                continue
            schema = summary.schemas.get(channel.schema_id)
            kind, encoding = schema.name if schema else "", channel.message_encoding
            known = found.get(channel.topic)
            if known is not None:
                kind = kind if known.type == kind else ""
                count += known.count
            found[channel.topic] = TopicSummary(channel.topic, kind, count, encoding)
    return dict(sorted(found.items()))
