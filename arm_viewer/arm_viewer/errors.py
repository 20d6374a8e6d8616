"""The errors of this package; each message says what is wrong, where, and what exists.

ViewerError
├── PageError     the page cannot be served: the port is taken, or no port
└── PictureError  an image message that cannot be drawn
"""


class ViewerError(Exception):
    """Root of this package's errors; the message is a sentence for the user."""


class PageError(ViewerError):
    """The page cannot be served; the message names the port."""


class PictureError(ViewerError):
    """An image that cannot be drawn; the message names its encoding and what can be drawn."""
