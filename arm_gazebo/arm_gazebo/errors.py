"""The errors of this package.

GazeboError
└── CameraError     a camera's description or its process
"""


class GazeboError(Exception):
    """Root of what this package raises; the message is a sentence for the user."""


class CameraError(GazeboError):
    """A camera is described wrongly, or its process cannot do its work."""
