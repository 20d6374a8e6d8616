"""What the page shows of a recording at a moment: the snapshot that its messages make."""

import logging
from collections.abc import Callable, Mapping
from dataclasses import dataclass, field
from functools import lru_cache
from itertools import islice
from types import MappingProxyType
from typing import Any

import cv2
import numpy as np
from rclpy.serialization import deserialize_message
from rosgraph_msgs.msg import Clock
from sensor_msgs.msg import CameraInfo, CompressedImage, Image, JointState
from std_msgs.msg import String
from tf2_msgs.msg import TFMessage
from visualization_msgs.msg import MarkerArray

from arm_node.workarounds.cdr_layout import LITTLE_ENDIAN, CdrLayout
from arm_node.workarounds.message_fields import float64_fields
from arm_viewer.plots.field_paths import numbers_in, parse_curve, reader
from arm_viewer.plots.history import Curves
from arm_viewer.recordings.curve import NumberPlace, read_samples
from arm_viewer.recordings.open_recording import Wanted
from arm_viewer.recordings.recorded_bag import CDR, RecordedBag, Sample
from arm_viewer.ros.camera_observer import camera_view, picture_of
from arm_viewer.ros.contact_observer import WORD as CONTACTS
from arm_viewer.ros.contact_observer import contact_forces
from arm_viewer.ros.graph_observer import message_class_of
from arm_viewer.ros.joint_observer import WORD as JOINT_STATES
from arm_viewer.ros.joint_observer import joint_readings
from arm_viewer.ros.marker_observer import WORD as MARKERS
from arm_viewer.ros.marker_observer import apply_marker
from arm_viewer.ros.observer import type_name
from arm_viewer.ros.robot_observer import DESCRIPTION_WORD, described, transforms_in
from arm_viewer.snapshot import (
    CameraView,
    ContactForces,
    Description,
    JointReading,
    JointStates,
    Marker,
    Picture,
    SimulationTime,
    Snapshot,
    Topic,
    Transform,
)

FOLLOWED_NS = 250_000_000
"""After a step of this length or less, only the messages in between are read."""
REACH_NS = 2_000_000_000
"""How far before a moment a moving frame or a joint is looked for."""
PATIENCE = 60
"""The search ends after so many messages in a row that name nothing new."""
PLOTTED_NS = 20_000_000_000
"""How much of a curve before a moment is plotted after a jump."""
MAX_LATCHED = 500
"""Newest messages of a topic that is published only when something changes."""
MAX_BYTES = 20_000
"""Longer messages are pictures, points or maps; nobody plots one of their numbers."""
MAX_NUMBERS = 200
MARK = 2.0**-900
"""Numbers are found by multiples of it, which nothing else in a message is."""
_IMAGES = (type_name(Image), type_name(CompressedImage))

_logger = logging.getLogger(__name__)

described_once = lru_cache(maxsize=8)(described)


@dataclass(slots=True)
class _Merged:
    """What several messages of a topic say together, each by name the latest."""

    time_ns: int = -1
    values: dict[str, Any] = field(default_factory=dict)


class RecordedState:
    """Makes snapshots of a recording; one thread at a time."""

    def __init__(self, recording: RecordedBag) -> None:
        """Read from this recording."""
        self._recording = recording
        self._merged: dict[str, _Merged] = {}
        self._decoded: dict[str, tuple[Sample, Any]] = {}
        self._unreadable: set[str] = set()
        self._curves = Curves()
        self._plotted: dict[str, dict[str, NumberPlace]] = {}
        self._plotted_names: frozenset[str] = frozenset()
        self._plotted_ns = -1
        self.reread()

    def reread(self) -> None:
        """Find the topics and numbers of the recording, as when it has got longer.

        Raises:
            PageRecordingError: the file is damaged.
        """
        recording = self._recording
        self._places = self.numbers()
        listed: dict[str, list[str]] = {}
        for topic, number in self._places:
            listed.setdefault(topic, []).append(number)
        self._listed = MappingProxyType({topic: tuple(found) for topic, found in listed.items()})
        length_s = 1e-9 * (recording.end_ns - recording.start_ns)
        self.topics = tuple(
            Topic(t.name, (t.type,), 1, 0, t.count / length_s if length_s > 0.0 else float("nan"))
            for t in recording.topics.values()
        )
        self.image_topics = tuple(
            t.name for t in recording.topics.values() if t.type in _IMAGES and t.encoding == CDR
        )

    def at(self, time_ns: int, now_s: float, speed: float, wanted: Wanted) -> Snapshot:
        """Return the state at a moment of the recording's time; the speed is 0 while it stands.

        The snapshot says that it was made at `now_s`.

        Raises:
            PageRecordingError: the file is damaged.
        """
        descriptions = self._descriptions(time_ns)
        joints = {
            topic: JointStates(MappingProxyType(values), now_s)
            for topic in self._named(JointState, f"/{JOINT_STATES}")
            if (values := self._merge(topic, JointState, joint_readings, time_ns))
        }
        transforms = self._transforms(time_ns)
        return Snapshot(
            made_s=now_s,
            replay=self._recording.path.name,
            descriptions=descriptions,
            transforms=transforms,
            joint_states=MappingProxyType(joints),
            hardware_positions=MappingProxyType({} if transforms else _positions(joints)),
            image_topics=self.image_topics,
            pictures=self._pictures(time_ns, wanted.pictures),
            cameras=self._cameras(time_ns),
            markers=self._markers(time_ns),
            contacts=self._contacts(time_ns),
            numbers=self._listed,
            curves=self._curves_at(time_ns, wanted.curves),
            curves_s=1e-9 * time_ns,
            time=self._time(time_ns, now_s, speed),
            topics=self.topics,
        )

    def numbers(self) -> Mapping[tuple[str, str], NumberPlace]:
        """Return where the numbers of its messages stand, by topic and name; joint states first.

        Raises:
            PageRecordingError: the file is damaged.
        """
        found: dict[tuple[str, str], NumberPlace] = {}
        topics = sorted(
            (t for t in self._recording.topics.values() if t.count > 1 and t.encoding == CDR),
            key=lambda topic: (topic.type != type_name(JointState), topic.name),
        )
        for topic in topics:
            message_class = message_class_of(topic.type)
            sample = self._recording.last(topic.name, self._recording.end_ns)
            if message_class is not None and sample is not None:
                places = number_places(sample.data, message_class)
                found |= {(topic.name, number): place for number, place in places.items()}
        return MappingProxyType(found)

    def _curves_at(self, time_ns: int, wanted: frozenset[str]) -> Curves:
        """Return the curves up to a moment: after a jump new ones, of PLOTTED_NS before it."""
        follows = 0 <= time_ns - self._plotted_ns <= PLOTTED_NS
        if not follows or wanted != self._plotted_names:
            self._plotted_names, self._plotted = wanted, {}
            for (topic, number), place in self._places.items():
                if f"{topic}.{number}" in wanted:
                    self._plotted.setdefault(topic, {})[f"{topic}.{number}"] = place
            self._curves = Curves()
            self._plotted_ns = time_ns - PLOTTED_NS
        for topic, places in self._plotted.items():
            times, rows = read_samples(
                self._recording, topic, list(places.values()), self._plotted_ns, time_ns
            )
            if len(times):
                self._curves.append(times, dict(zip(places, rows, strict=True)))
        self._plotted_ns = time_ns
        return self._curves

    def _descriptions(self, time_ns: int) -> Mapping[str, Description]:
        found: dict[str, Description] = {}
        for topic in self._named(String, f"/{DESCRIPTION_WORD}"):
            message = self._last(topic, String, time_ns)
            if message is not None:
                found[topic] = described_once(topic, message.data)
        return MappingProxyType(found)

    def _transforms(self, time_ns: int) -> Mapping[str, Transform]:
        found: dict[str, Transform] = {}
        for message in self._latched("/tf_static", TFMessage, time_ns):
            found.update(transforms_in(message))
        if "/tf" in self._named(TFMessage, "/tf"):
            found.update(self._merge("/tf", TFMessage, transforms_in, time_ns))
        return MappingProxyType(found)

    def _pictures(self, time_ns: int, wanted: frozenset[str]) -> Mapping[str, Picture]:
        found: dict[str, Picture] = {}
        for topic in wanted.intersection(self.image_topics):
            is_plain = self._recording.topics[topic].type == _IMAGES[0]
            read = picture_of if is_plain else _unpacked_picture
            picture = self._last(topic, Image if is_plain else CompressedImage, time_ns, read)
            if picture is not None:
                found[topic] = picture
        return MappingProxyType(found)

    def _cameras(self, time_ns: int) -> Mapping[str, CameraView]:
        found = {
            topic: self._last(topic, CameraInfo, time_ns, camera_view)
            for topic in self._named(CameraInfo, "")
        }
        return MappingProxyType({topic: view for topic, view in found.items() if view is not None})

    def _markers(self, time_ns: int) -> Mapping[str, Marker]:
        markers: dict[str, Marker] = {}
        for topic in self._named(MarkerArray, f"/{MARKERS}"):
            for message in self._latched(topic, MarkerArray, time_ns):
                for marker in message.markers:
                    apply_marker(markers, topic, marker)
        return MappingProxyType(markers)

    def _contacts(self, time_ns: int) -> ContactForces | None:
        """Return the latest contacts of all simulations, as the live page shows them."""
        samples = {
            topic: sample
            for topic in self._named(MarkerArray, f"/{CONTACTS}")
            if (sample := self._recording.last(topic, time_ns)) is not None
        }
        if not samples:
            return None
        newest = max(samples, key=lambda topic: samples[topic].time_ns)
        return self._last(newest, MarkerArray, time_ns, contact_forces)

    def _time(self, time_ns: int, now_s: float, speed: float) -> SimulationTime | None:
        clock = self._last("/clock", Clock, time_ns) if self._named(Clock, "/clock") else None
        if clock is None:
            return None
        time_s = clock.clock.sec + 1e-9 * clock.clock.nanosec
        return SimulationTime(time_s, speed, 0.0, now_s)

    def _named(self, message_class: type, suffix: str) -> list[str]:
        """Return the topics of a type whose names have an ending."""
        wanted = type_name(message_class)
        return [
            topic.name
            for topic in self._recording.topics.values()
            if topic.type == wanted and topic.encoding == CDR and topic.name.endswith(suffix)
        ]

    def _last(
        self,
        topic: str,
        message_class: type,
        time_ns: int,
        read: Callable[[Any], Any] = lambda message: message,
    ) -> Any:
        """Return what the last message of a topic says; None without one that can be read."""
        sample = self._recording.last(topic, time_ns)
        if sample is None:
            return None
        known = self._decoded.get(topic)
        if known is None or known[0] is not sample:
            message = self._message(topic, message_class, sample)
            known = self._decoded[topic] = (sample, None if message is None else read(message))
        return known[1]

    def _latched(self, topic: str, message_class: type, time_ns: int) -> list[Any]:
        """Return the messages of a topic up to a moment, the latest MAX_LATCHED of them."""
        newest = self._recording.last(topic, time_ns)
        if newest is None:
            return []
        known = self._decoded.get(topic)
        if known is None or known[0] is not newest:
            samples = list(islice(self._recording.backwards(topic, time_ns), MAX_LATCHED))
            found = [self._message(topic, message_class, sample) for sample in reversed(samples)]
            known = self._decoded[topic] = (newest, [m for m in found if m is not None])
        return known[1]

    def _merge(
        self,
        topic: str,
        message_class: type,
        read: Callable[[Any], dict[str, Any]],
        time_ns: int,
    ) -> dict[str, Any]:
        """Return what the messages before a moment say, by name, as publishers share a topic."""
        before = self._merged.get(topic, _Merged())
        follows = 0 <= time_ns - before.time_ns <= FOLLOWED_NS
        reach_ns = before.time_ns if follows else time_ns - REACH_NS
        found: dict[str, Any] = {}
        idle = 0
        for sample in self._recording.backwards(topic, time_ns):
            # The last message counts, however old it is.
            is_old = sample.time_ns <= reach_ns and (follows or found)
            if is_old or (idle >= PATIENCE and not follows):
                break
            message = self._message(topic, message_class, sample)
            new = {} if message is None else read(message)
            idle = 0 if new.keys() - found.keys() else idle + 1
            found = {**new, **found}
        values = {**before.values, **found} if follows else found
        self._merged[topic] = _Merged(time_ns, values)
        return values

    def _message(self, topic: str, message_class: type, sample: Sample) -> Any:
        try:
            return deserialize_message(sample.data, message_class)
        except Exception as error:
            # rclpy raises any kind of error at bytes that are not a message of the type.
            if topic not in self._unreadable:
                self._unreadable.add(topic)
                _logger.warning("messages of %s cannot be read: %s", topic, error)
            return None


def _positions(joints: Mapping[str, JointStates]) -> dict[str, Mapping[str, float]]:
    """Return the joints' positions by namespace, for a recording without transforms."""

    def known(readings: Mapping[str, JointReading]) -> dict[str, float]:
        return {n: r.position for n, r in readings.items() if np.isfinite(r.position)}

    return {topic.removesuffix(f"/{JOINT_STATES}"): known(s.joints) for topic, s in joints.items()}


def _unpacked_picture(message: CompressedImage) -> Picture | None:
    """Return the picture of a JPEG or PNG; None if OpenCV cannot read it."""
    pixels = cv2.imdecode(np.frombuffer(message.data, dtype=np.uint8), cv2.IMREAD_COLOR)
    if pixels is None:
        return None
    height, width = pixels.shape[:2]
    return Picture("bgr8", width, height, 3 * width, False, pixels.reshape(-1).astype(np.uint8))


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
