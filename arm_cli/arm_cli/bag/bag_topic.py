"""A recorded topic, the definition of its type, and a message."""

from dataclasses import dataclass
from typing import NamedTuple

from arm_cli.bag.offered_qos import OfferedQos
from arm_cli.errors import NoSuchNameError
from arm_cli.interfaces.definition import nested_type
from arm_cli.interfaces.index import InterfaceIndex

ENCODING = "ros2msg"
SEPARATOR = "=" * 80


@dataclass(frozen=True, slots=True)
class TypeDefinition:
    """The definition of a type.

    Attributes:
        name: the name of the type.
        text: its .msg file, then those of the types of its fields; empty if one is missing.
    """

    name: str
    text: str

    @property
    def encoding(self) -> str:
        """The schema encoding; MCAP requires it to be empty if there is no text."""
        return ENCODING if self.text else ""


def find_definition(index: InterfaceIndex, name: str) -> TypeDefinition:
    """Return a type's definition; the text is empty if it or a nested type is not installed."""
    try:
        return TypeDefinition(name, _joined(index, name))
    except (NoSuchNameError, OSError, UnicodeDecodeError):
        return TypeDefinition(name, "")


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
    serialization_format: str = "cdr"


class BagMessage(NamedTuple):
    """A serialized message; a tuple, because one is created for every received message.

    Attributes:
        topic: the topic's name.
        log_time_ns: the time of its reception.
        publish_time_ns: the time of its publication.
        data: the bytes on the wire, with the encapsulation header.
    """

    topic: str
    log_time_ns: int
    publish_time_ns: int
    data: bytes
