"""The errors of this package; each message says what is wrong, where, and what exists.

ViewerError
├── BrowserMessageError  a browser sent something that the page cannot serve
├── ConfigError          a file is not an RViz configuration
├── DroppedFileError     a file that was dropped on the page cannot be simulated
├── PageError            the page cannot be served: the port is taken or invalid
├── PictureError         an image message cannot be drawn
└── PageRecordingError   a recording cannot be made, read or shown
"""


class ViewerError(Exception):
    """Base class of this package's errors; the message is a sentence for the user."""


class ConfigError(ViewerError):
    """A file is not an RViz configuration, or cannot be read; the message names it."""


class BrowserMessageError(ViewerError):
    """A message from a browser cannot be served; the sentence is shown in that browser."""


class DroppedFileError(ViewerError):
    """A file that was dropped on the page cannot be simulated; the message says why."""


class PageError(ViewerError):
    """The page cannot be served; the message names the port."""


class PictureError(ViewerError):
    """An image cannot be drawn; the message names its encoding and the supported ones."""


class PageRecordingError(ViewerError):
    """A recording cannot be made, read or shown; the message names it and says why."""
