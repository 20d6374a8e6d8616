"""A recorded topic, the definition of its type, and a message."""

from dataclasses import dataclass, replace
from typing import NamedTuple

from arm_cli.bag_format.offered_qos import OfferedQos
from arm_cli.errors import NoSuchNameError
from arm_cli.interface_types import InterfaceIndex, nested_type, without_comment

ENCODING = "ros2msg"
CDR = "cdr"
"""The format of ROS 2's messages."""
SEPARATOR = "=" * 80
PLACEHOLDER = "structure_needs_at_least_one_member"
"""The field that some writers give a type without fields."""
ALIASES = {"byte": "uint8", "char": "uint8", "octet": "uint8"}
"""Other names of primitive types."""


@dataclass(frozen=True, slots=True)
class TypeDefinition:
    """The definition of a type.

    Attributes:
        name: the name of the type.
        data: its .msg file, then those of the types of its fields, or another language's
            definition; empty if it is unknown.
        language: the schema encoding of MCAP, such as ros2msg or ros2idl.
    """

    name: str
    data: bytes
    language: str = ENCODING

    @property
    def text(self) -> str:
        """The definition as text."""
        return self.data.decode("utf-8", "replace")

    @property
    def encoding(self) -> str:
        """The schema encoding; MCAP requires it to be empty if there is no text."""
        return self.language if self.data else ""

    def contradicts(self, other: "TypeDefinition") -> bool:
        """Return whether the two are known to define different fields."""
        if not self.data or not other.data or self.language != other.language:
            return False
        return self._fields() != other._fields()

    def _fields(self) -> object:
        """Return what decides how bytes are read: fields without comments, constants, defaults."""
        if self.language != ENCODING:
            return self.data
        fields: dict[str, list[tuple[str, str]]] = {}
        name = self.name.replace("/msg/", "/")
        for line in map(without_comment, self.text.splitlines()):
            if line.startswith("MSG:"):
                name = line.removeprefix("MSG:").strip().replace("/msg/", "/")
            elif not line.startswith("=" * 10):
                fields.setdefault(name, []).extend(_field(line, name.split("/")[0]))
        return fields


def _field(line: str, package: str) -> list[tuple[str, str]]:
    """Return type and name of the field in a line, nothing if the line has none."""
    words = line.replace("=", " = ", 1).split() if "<=" not in line else line.split()
    if len(words) < 2 or words[2:3] == ["="] or words[1] == PLACEHOLDER:
        return []
    kind, bracket, size = words[0].partition("[")
    nested = nested_type(line, package)
    plain = nested.replace("/msg/", "/") if nested else ALIASES.get(kind, kind)
    return [(plain + bracket + size, words[1])]


def find_definition(index: InterfaceIndex, name: str) -> TypeDefinition:
    """Return a type's definition; the data are empty if it or a nested type is not installed."""
    try:
        return TypeDefinition(name, _joined(index, name).encode())
    except (NoSuchNameError, OSError, UnicodeDecodeError):
        return TypeDefinition(name, b"")


def _joined(index: InterfaceIndex, name: str) -> str:
    text = _text(index, name)
    parts = [text]
    # Each type occurs once, and types closer to the root come first.
    found = _nested(text, name)
    for inner in found:
        text = _text(index, inner)
        package, _, stem = inner.split("/")
        parts.append(f"{SEPARATOR}\nMSG: {package}/{stem}\n{text}")
        found.extend(other for other in _nested(text, inner) if other not in found)
    return "\n".join(parts)


def _text(index: InterfaceIndex, name: str) -> str:
    return index.find(name, ("msg",)).path.read_text(encoding="utf-8")


def _nested(text: str, name: str) -> list[str]:
    package = name.split("/")[0]
    found = (nested_type(line, package) for line in text.splitlines())
    return list(dict.fromkeys(inner for inner in found if inner is not None))


@dataclass(frozen=True, slots=True)
class BagTopic:
    """A topic of a bag.

    Attributes:
        name: its absolute name.
        type: its type, such as sensor_msgs/msg/JointState.
        type_hash: RIHS01_ and 64 hexadecimal digits; empty if unknown.
        offers: the QoS of its publishers at the time of the subscription.
        serialization_format: the format of its messages.
    """

    name: str
    type: str
    type_hash: str = ""
    offers: tuple[OfferedQos, ...] = ()
    serialization_format: str = CDR


@dataclass(frozen=True, slots=True)
class RecordedTopic:
    """A topic with what its messages are, and how many it has."""

    topic: BagTopic
    definition: TypeDefinition
    count: int

    def is_same(self, other: "RecordedTopic") -> bool:
        """Return whether the messages of both can be read alike, as far as is known."""
        a, b = self.topic, other.topic
        if (a.name, a.type, a.serialization_format) != (b.name, b.type, b.serialization_format):
            return False
        known_hashes = {topic.type_hash for topic in (a, b) if topic.type_hash}
        return len(known_hashes) < 2 and not self.definition.contradicts(other.definition)

    def joined(self, other: "RecordedTopic") -> "RecordedTopic":
        """Return both as one topic, with what the first one knows, or else the other."""
        return RecordedTopic(
            replace(
                self.topic,
                type_hash=self.topic.type_hash or other.topic.type_hash,
                offers=self.topic.offers or other.topic.offers,
            ),
            self.definition if self.definition.data else other.definition,
            self.count + other.count,
        )

    def unreadable_reason(self, index: InterfaceIndex) -> str | None:
        """Return why the installed type cannot read the messages, None if it can."""
        topic = self.topic
        if topic.serialization_format != CDR:
            return f"its messages are {topic.serialization_format or 'of no format'}, not {CDR}"
        if not topic.type:
            return "the bag does not say its type"
        if self.definition.contradicts(find_definition(index, topic.type)):
            return f"the definition of {topic.type} has changed"
        return None


class BagMessage(NamedTuple):
    """A serialized message as on the wire, with its times of reception and publication.

    It is a tuple, because one is created for every received message.
    """

    topic: str
    log_time_ns: int
    publish_time_ns: int
    data: bytes
