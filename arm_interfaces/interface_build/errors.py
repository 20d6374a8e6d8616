"""The errors of a build.

BuildError
|-- MissingToolError    a compiler or a header is not installed
|-- MissingRosError     the ROS 2 wheels were not found
`-- CompileError        the compiler or the linker refused its input
"""


class BuildError(Exception):
    """Root of this package's errors; the message is for the user."""


class MissingToolError(BuildError):
    """A compiler or a header that the build needs is not installed."""


class MissingRosError(BuildError):
    """The ROS 2 wheels were not found."""


class CompileError(BuildError):
    """The compiler or the linker refused its input."""
