"""What can go wrong in a build.

BuildError
|-- MissingToolError    a compiler or a header is not installed
|-- MissingRosError     the ROS 2 wheels are not where the build looks
`-- CompileError        the compiler or the linker refused its input
"""


class BuildError(Exception):
    """Root of all errors that a build raises on purpose; the message is for the user."""


class MissingToolError(BuildError):
    """A compiler or a header that the build needs is not installed."""


class MissingRosError(BuildError):
    """The ROS 2 wheels are not where the build looks."""


class CompileError(BuildError):
    """The compiler or the linker refused its input."""
