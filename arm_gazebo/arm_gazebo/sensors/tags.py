"""The tags of one `<sensor>` of a URDF: typed look-ups whose errors name element and line."""

import math
import re
from collections import Counter
from collections.abc import Callable, Collection, Container, Iterator, Sequence
from typing import Protocol

from arm_description.urdf.element import UrdfElement
from arm_description.urdf.xml_document import finite_number
from arm_gazebo.build_report import BuildOutcome, Finding
from arm_gazebo.errors import SensorError

COLOR_FORMATS = ("R8G8B8", "RGB_INT8", "rgb8")
FRAME_TAGS = ("optical_frame_id", "gz_frame_id", "ignition_frame_id")
TOPIC = re.compile(r"~?/?[A-Za-z_][A-Za-z0-9_]*(/[A-Za-z_][A-Za-z0-9_]*)*")
HARMLESS = ("always_on", "visualize", "enable_metrics")
"""Tags that change no reading: a sensor works while somebody listens."""
UNCHANGED = ("", "false", "0", "euler_rpy")
"""Values of attributes that say what holds without them."""
COUNTS = {2: "two", 6: "six"}
_NO_TOPIC = re.compile(r"[^A-Za-z0-9_/]")
_SLASHES = re.compile(r"/+")
_DIGIT_FIRST = re.compile(r"(^|/)(?=[0-9])")


class _AttachedSensor(Protocol):
    """A named sensor on a link."""

    @property
    def name(self) -> str:
        """The sensor's name."""
        ...

    @property
    def link(self) -> str:
        """The link that carries it."""
        ...


def unique_names(sensors: Sequence[_AttachedSensor]) -> list[str]:
    """Return names that are unique in the robot: LINK/NAME if several links use the same name.

    In Gazebo, names are unique only within a link.
    """
    names = Counter(sensor.name for sensor in sensors)
    return [s.name if names[s.name] == 1 else f"{s.link}/{s.name}" for s in sensors]


class SensorTags:
    """The tags of one `<sensor>`. It remembers what was looked up, to tell which tags nobody reads.

    `below` is the child element that may hold the tags as well; by default that of the type's name,
    such as `<imu>`.

    Attributes:
        reference: the link or joint that it is attached to.
        name: the sensor's name.
        type: the sensor's type.

    Raises:
        SensorError: the sensor has no name.
    """

    def __init__(
        self, element: UrdfElement, reference: str, type_name: str, below: str | None = None
    ) -> None:
        self._element = element
        self._inner = element.find(below or type_name)
        self._known: set[str] = set(HARMLESS)
        self._single: set[str] = set()
        self._doubts: list[Finding] = []
        self.reference = reference
        self.type = type_name
        self.name = element.text("name")
        if not self.name:
            raise self.error("sensor", "a sensor needs a name")

    def error(self, tag: str, problem: str, element: UrdfElement | None = None) -> SensorError:
        """Return an error about one tag or attribute of this sensor."""
        line = (element or self._element).line
        return SensorError(f"{self.type} sensor {self.name!r}, <{tag}> (line {line}): {problem}")

    def doubt(self, tag: str, problem: str) -> None:
        """Note that a tag, or the sensor ("."), is probably not what its author meant."""
        (found, *_) = self._find(tag)
        self._doubts.append(self._finding(BuildOutcome.DOUBTFUL, found, tag, problem))

    def findings(self) -> Iterator[Finding]:
        """Yield what is doubtful, and each tag that nobody looked up; call it after reading."""
        yield from self._doubts
        above = {
            known[:end] for known in self._known for end, char in enumerate(known) if char == "/"
        }
        yield from self._unread(self._element, "", set(), above)

    def topic_error(self, topic: str, kind: str, owner: _AttachedSensor) -> SensorError:
        """Return an error about a topic of this sensor that another sensor uses."""
        return self.error(
            "topic",
            f"{topic!r} is taken by {kind} {owner.name!r} of link {owner.link!r}; give one of them "
            "another <topic>",
        )

    def check_reference(self, kind: str, known: Collection[str]) -> None:
        """Check that the link or joint exists.

        Raises:
            SensorError: it does not exist; the message names those that do.
        """
        if self.reference not in known:
            raise self.error(
                "gazebo", f"no {kind} {self.reference!r}; the robot has {', '.join(known)}"
            )

    def texts(self, *tags: str) -> list[tuple[UrdfElement, str]]:
        """Return element and text of every non-empty tag of these names, outer ones first."""
        found = (element for tag in tags for element in self._find(tag))
        return [(element, element.content) for element in found if element.content]

    def has(self, tag: str) -> bool:
        """Return whether there is a tag of this name."""
        return bool(self._find(tag))

    def ignore(self, *tags: str) -> None:
        """Count tags, and all that is in them, as read: they have nothing to say here."""
        self._known.update(tags)

    def attribute(self, tag: str, name: str) -> str:
        """Return an attribute of the first tag of this name; empty if there is none."""
        self._known.add(f"{tag}@{name}")
        found = self._find(tag)
        return found[0].text(name) if found else ""

    def number(
        self, tag: str, default: float, fits: Callable[[float], bool], must_be: str
    ) -> float:
        """Return a finite number that `fits` accepts; `must_be` words the condition for errors."""
        self._single.add(tag)
        for element, text in self.texts(tag):
            value = finite_number(text)
            if math.isnan(value) or not fits(value):
                raise self.error(tag, f"must be {must_be}, not {text!r}", element)
            return value
        return default

    def rate_hz(self) -> float:
        """Return the update rate; 0 means every step, as in Gazebo."""
        return self.number("update_rate", 0.0, lambda v: v >= 0, "at least 0")

    def choice(self, tag: str, choices: tuple[str, ...]) -> str:
        """Return a tag's text, or the first choice if the tag is missing."""
        self._single.add(tag)
        for element, text in self.texts(tag):
            if text not in choices:
                raise self.error(tag, f"{text!r} is not one of {', '.join(choices)}", element)
            return text
        return choices[0]

    def topics(self, tag: str) -> tuple[str, ...]:
        """Return the valid ROS topic names that the tags of this name hold."""
        names: list[str] = []
        for element, text in self.texts(tag):
            if not TOPIC.fullmatch(text):
                raise self.error(tag, f"{text!r} is not a valid ROS topic name", element)
            names.append(text)
        return tuple(dict.fromkeys(names))

    def own_topics(self) -> tuple[str, ...]:
        """Return the topics in `<topic>`, or else a topic made from the sensor's name."""
        return self.topics("topic") or (_topic_of(self.name),)

    def frame(self, default: str) -> str:
        """Return the frame in the messages' headers."""
        frames = self.texts(*FRAME_TAGS)
        return frames[0][1] if frames else default

    def numbers(self, tag: str, default: tuple[float, ...]) -> tuple[float, ...]:
        """Return a tag's finite numbers, as many as the default has."""
        self._single.add(tag)
        for element, text in self.texts(tag):
            values = tuple([finite_number(word) for word in text.split()])
            if len(values) != len(default) or any(map(math.isnan, values)):
                wanted = f"{COUNTS[len(default)]} numbers"
                raise self.error(tag, f"{text!r} is not {wanted}", element)
            return values
        return default

    def pose(self) -> tuple[float, ...]:
        """Return x y z roll pitch yaw of the sensor in its link or joint."""
        return self.numbers("pose", (0.0,) * 6)

    def _find(self, tag: str) -> list[UrdfElement]:
        """Return the tags of this name, outer ones first."""
        self._known.add(tag)
        if tag == ".":
            return [self._element, *self._inner]
        return [found for outer in (self._element, *self._inner) for found in outer.find(tag)]

    def _unread(
        self, element: UrdfElement, path: str, seen: set[str], above: Container[str]
    ) -> Iterator[Finding]:
        for child in element.elements:
            here = path + child.tag
            if here in self._known:
                yield from self._unread_attributes(child, here)
            if child in self._inner:
                yield from self._unread(child, "", seen, above)
            elif here in above:
                yield from self._unread(child, here + "/", seen, above)
            elif here not in self._known:
                problem = "the simulation does not use it"
                yield self._finding(BuildOutcome.DROPPED, child, here, problem)
            elif here in seen and here in self._single:
                problem = "there is another one, and only one counts"
                yield self._finding(BuildOutcome.DOUBTFUL, child, here, problem)
            seen.add(here)

    def _unread_attributes(self, element: UrdfElement, path: str) -> Iterator[Finding]:
        for name, value in element.attributes.items():
            if f"{path}@{name}" not in self._known and value.strip() not in UNCHANGED:
                problem = f"the simulation does not use {name}='{value}'"
                yield self._finding(BuildOutcome.DROPPED, element, path, problem)

    def _finding(
        self, outcome: BuildOutcome, element: UrdfElement, tag: str, problem: str
    ) -> Finding:
        owner = f"{self.type} '{self.name}'"
        name = owner if element is self._element else f"<{tag}> of {owner}"
        return Finding(outcome, name, problem, element.line)


def _topic_of(name: str) -> str:
    """Return a valid ROS topic name that resembles the given name."""
    topic = _SLASHES.sub("/", _NO_TOPIC.sub("_", name)).rstrip("/")
    return _DIGIT_FIRST.sub(r"\1_", topic) or "sensor"
