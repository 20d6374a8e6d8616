"""The name of a frame, from a message's."""


def frame_name(frame_id: str) -> str:
    """Return the name without the slash that it may begin with, which tf2 passes over as well."""
    return frame_id.removeprefix("/")
