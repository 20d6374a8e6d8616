"""Formats Gazebo's messages in protobuf's text format, as Gazebo's tools print them."""

from collections.abc import Iterator, Mapping
from typing import Any

Fields = Mapping[str, Any]
"""Values by field name: numbers, texts, nested fields, or lists. Zero and "" are not printed."""


def text_of(fields: Fields) -> str:
    """Return the text format of a message, with a newline after each line."""
    return "".join(f"{line}\n" for line in _lines(fields))


def _lines(fields: Fields) -> Iterator[str]:
    for name, value in fields.items():
        for item in value if isinstance(value, list) else [value]:
            if isinstance(item, Mapping):
                yield f"{name} {{"
                yield from (f"  {line}" for line in _lines(item))
                yield "}"
            elif isinstance(item, str):
                if item:
                    yield f'{name}: "{item}"'
            elif item:
                yield f"{name}: {item:.17g}" if isinstance(item, float) else f"{name}: {item}"


def time_of(seconds: float) -> Fields:
    """Return the fields of a gz.msgs.Time."""
    whole = int(seconds)
    return {"sec": whole, "nsec": round((seconds - whole) * 1e9)}


def pose_of(name: str, number: int, pose: Any) -> Fields:
    """Return the fields of a gz.msgs.Pose.

    Args:
        name: the name of the entity.
        number: the id of the entity.
        pose: its pose, a geometry_msgs/msg/Pose.
    """
    p, q = pose.position, pose.orientation
    return {
        "name": name,
        "id": number,
        "position": {"x": p.x, "y": p.y, "z": p.z},
        "orientation": {"x": q.x, "y": q.y, "z": q.z, "w": q.w},
    }
