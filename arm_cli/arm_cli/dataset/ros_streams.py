"""Reads the messages of a bag as the streams of one episode."""

from collections.abc import Callable, Iterator
from typing import Any

import numpy as np
from numpy.typing import NDArray
from rclpy.serialization import deserialize_message

from arm_cli.bag_format.reader import BagReader
from arm_cli.bag_format.topic import BagTopic
from arm_cli.dataset.selection import (
    COMMANDS,
    COMPRESSED,
    CONTROLLER_STATE,
    JOINT_STATE,
    ChosenTopics,
    DatasetOptions,
)
from arm_cli.errors import BagError
from arm_cli.interface_types import InterfaceIndex, load_class
from arm_sim.dataset import CameraStream, Samples

Stamps = NDArray[np.int64]
CHANNELS = {"rgb8": (0, 1, 2), "bgr8": (2, 1, 0), "rgba8": (0, 1, 2), "bgra8": (2, 1, 0)}
"""Indices of red, green and blue in a pixel."""


class EpisodeReader:
    """Reads the chosen topics of one bag."""

    def __init__(self, reader: BagReader, chosen: ChosenTopics, wanted: DatasetOptions) -> None:
        self._reader, self._chosen, self._wanted = reader, chosen, wanted
        self.remarks: list[str] = []
        """One sentence for each peculiarity of the stamps that a user should know about."""

    def streams(self) -> tuple[list[Samples | CameraStream], int]:
        """Return cameras, states and actions, and the index of the stream that defines the rows.

        Raises:
            BagError: messages have no stamps, or do not fit together.
        """
        state, clock = self._states()
        cameras = [self._camera(name, topic) for name, topic in self._chosen.cameras.items()]
        return [*cameras, state, self._actions(state, clock)], 0

    def _states(self) -> tuple[Samples, tuple[Stamps, Stamps]]:
        """Return the states, and their times in the bag with their stamps."""
        topic = self._chosen.state.name
        logs, stamps, rows = list[int](), list[int](), list[list[float]]()
        names: tuple[str, ...] = ()
        for log_ns, message in self._messages(self._chosen.state):
            names = names or tuple(message.name)
            if set(message.name) != set(names):
                raise BagError(
                    f"messages of {topic} have different joints; choose one with --state"
                )
            place = {name: index for index, name in enumerate(message.name)}
            fields = [getattr(message, field) for field in self._wanted.fields]
            for field, values in zip(self._wanted.fields, fields, strict=True):
                if len(values) < len(names):
                    raise BagError(f"messages of {topic} do not have the {field} of every joint")
            logs.append(log_ns)
            stamps.append(_stamp_ns(message.header.stamp))
            rows.append([float(values[place[name]]) for values in fields for name in names])
        labels = tuple(f"{name}.{field[:3]}" for field in self._wanted.fields for name in names)
        kept = self._increasing(topic, np.array(stamps, dtype=np.int64))
        own = np.array(stamps, dtype=np.int64)[kept]
        values = np.array(rows, dtype=np.float32)[kept]
        clock = (np.array(logs, dtype=np.int64)[kept], own)
        return Samples("observation.state", own, values, labels), clock

    def _actions(self, state: Samples, clock: tuple[Stamps, Stamps]) -> Samples:
        topic = self._chosen.action
        stamps, rows, names = list[int](), list[list[float]](), list[tuple[str, ...]]()
        for log_ns, message in self._messages(topic):
            values, labels, stamp = _action(topic.type, message)
            if stamp is None:
                before = int(np.searchsorted(clock[0], log_ns, side="right")) - 1
                stamp = int(clock[1][max(before, 0)])
            stamps.append(stamp)
            rows.append(values)
            names.append(labels)
        if len({len(values) for values in rows}) > 1:
            raise BagError(f"messages of {topic.name} have different numbers of values")
        if topic.type == COMMANDS:
            self.remarks.append(
                f"{topic.name} has no stamps: a command gets the stamp of the last state before it"
            )
        kept = self._increasing(topic.name, np.array(stamps, dtype=np.int64), last=True)
        values = np.array(rows, dtype=np.float32)[kept]
        joints = tuple(label.partition(".")[0] for label in state.names)
        unnamed = (
            joints if len(joints) == values.shape[1] else tuple(map(str, range(values.shape[1])))
        )
        labels = tuple(f"{name}.cmd" for name in names[0] or unnamed)
        return Samples("action", np.array(stamps, dtype=np.int64)[kept], values, labels)

    def _camera(self, name: str, topic: BagTopic) -> CameraStream:
        stamps, size = list[int](), (0, 0)
        decode = _decode_compressed if topic.type == COMPRESSED else _decode
        for _, message in self._messages(topic):
            size = decode(message, topic.name).shape[:2] if not stamps else size
            stamps.append(_stamp_ns(message.header.stamp))
        kept = self._increasing(topic.name, np.array(stamps, dtype=np.int64))
        wanted = set(np.flatnonzero(kept).tolist())

        def images() -> Iterator[NDArray[np.uint8]]:
            for index, (_, message) in enumerate(self._messages(topic)):
                if index in wanted:
                    image = decode(message, topic.name)
                    if image.shape[:2] != size:
                        raise BagError(f"images of {topic.name} have different sizes")
                    yield image

        own = np.array(stamps, dtype=np.int64)[kept]
        return CameraStream(f"observation.images.{name}", own, size[0], size[1], images)

    def _increasing(self, topic: str, stamps: Stamps, last: bool = False) -> NDArray[np.bool_]:
        """Return which messages to keep so that stamps increase; add a remark about the others.

        Args:
            topic: name of the topic, for the remark.
            stamps: the stamps of all messages.
            last: whether the last of several messages with the same stamp is kept instead of the
                first.
        """
        highest = np.maximum.accumulate(stamps)
        kept = np.ones(len(stamps), dtype=bool)
        if last:
            kept[:-1] = stamps[:-1] != stamps[1:]
        else:
            kept[1:] = stamps[1:] != stamps[:-1]
        kept &= stamps == highest
        left = int((~kept).sum())
        if left:
            self.remarks.append(
                f"{left} messages of {topic} are left out: others have the same or a later stamp"
            )
        return kept

    def _messages(self, topic: BagTopic) -> Iterator[tuple[int, Any]]:
        index = InterfaceIndex()
        for one in self._reader.recorded_topics:
            reason = one.unreadable_reason(index) if one.topic == topic else None
            if reason is not None:
                raise BagError(f"{topic.name} cannot be read: {reason}")
        kind = load_class(index.find(topic.type, ("msg",)))
        for message in self._reader.messages([topic.name]):
            yield message.log_time_ns, deserialize_message(message.data, kind)


def _stamp_ns(stamp: Any) -> int:
    return int(stamp.sec) * 1_000_000_000 + int(stamp.nanosec)


def _action(kind: str, message: Any) -> tuple[list[float], tuple[str, ...], int | None]:
    """Return values, joints and stamp of a command; None for no stamp."""
    if kind == COMMANDS:
        return list(message.data), (), None
    stamp = _stamp_ns(message.header.stamp)
    if kind == CONTROLLER_STATE:
        return list(message.reference.positions), tuple(message.joint_names), stamp
    assert kind == JOINT_STATE
    return list(message.position), tuple(message.name), stamp


def _decode(message: Any, topic: str) -> NDArray[np.uint8]:
    """Return an image, RGB, shape (h, w, 3).

    Raises:
        BagError: it has no colours, or less data than pixels.
    """
    channels = CHANNELS.get(message.encoding)
    if channels is None:
        raise BagError(
            f"images of {topic} are {message.encoding}; those of a dataset are "
            f"{', '.join(CHANNELS)}; choose others with --cameras"
        )
    height, width = message.height, message.width
    count = 4 if message.encoding.endswith("a8") else 3
    data = np.frombuffer(message.data, dtype=np.uint8)
    if message.step < width * count or data.size < height * message.step:
        raise BagError(f"an image of {topic} has fewer bytes than pixels")
    rows = data[: height * message.step].reshape(height, message.step)[:, : width * count]
    return rows.reshape(height, width, count)[:, :, channels]


def _decode_compressed(message: Any, topic: str) -> NDArray[np.uint8]:
    import cv2

    decoder: Callable[..., Any] = cv2.imdecode
    image = decoder(np.frombuffer(message.data, dtype=np.uint8), cv2.IMREAD_COLOR)
    if image is None:
        raise BagError(f"an image of {topic} cannot be decoded")
    return image[:, :, ::-1]
