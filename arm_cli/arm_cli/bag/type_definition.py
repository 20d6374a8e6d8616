"""The text of a message type and of all types inside it, as MCAP's `ros2msg` schemas have it."""

from dataclasses import dataclass

from arm_cli.errors import NotFoundError
from arm_cli.interfaces.definition import nested_type
from arm_cli.interfaces.index import InterfaceIndex

SEPARATOR = "=" * 80


@dataclass(frozen=True, slots=True)
class TypeDefinition:
    """Definition of a type.

    Attributes:
        name: of the type.
        text: its .msg file, then those of the types of its fields; empty where one is missing.
    """

    name: str
    text: str

    @property
    def encoding(self) -> str:
        """The schema encoding; MCAP wants it empty where there is no text."""
        return "ros2msg" if self.text else ""


def find_definition(index: InterfaceIndex, name: str) -> TypeDefinition:
    """Return a type's definition; without a text where it, or one inside it, is not installed."""
    try:
        return TypeDefinition(name, _joined(index, name))
    except (NotFoundError, OSError, UnicodeDecodeError):
        return TypeDefinition(name, "")


def _joined(index: InterfaceIndex, name: str) -> str:
    text = _text(index, name)
    parts = [text]
    # Each type once, those that are nearer to the root first.
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
