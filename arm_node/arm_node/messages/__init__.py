"""Converts messages to text and text to messages."""


class MessageValueError(ValueError):
    """Values do not fit the fields of a message; the sentence names the field."""
