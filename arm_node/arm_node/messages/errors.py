"""The error of values that do not fit a message."""


class MessageValueError(ValueError):
    """Values do not fit the fields of a message; the sentence names the field."""
