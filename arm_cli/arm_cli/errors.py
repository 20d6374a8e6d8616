"""What can go wrong on the command line, in the user's words.

ArmCliError
|-- UsageError          the words of the command make no sense
|-- NotFoundError       no such topic, node, service, type, file, ...
|-- MessageError        values do not fit a message's fields
|-- BagError            a recording cannot be written or read
|-- RefusedError        a simulation answers that it cannot do what is asked for
`-- UnansweredError     somebody who should answer does not
"""

import signal


class ArmCliError(Exception):
    """Root: the message is one sentence for the user."""

    exit_code = 1


class UsageError(ArmCliError):
    """The words of the command make no sense."""

    exit_code = 2


class NotFoundError(ArmCliError):
    """Something that was named does not exist; the message names what does."""


class MessageError(ArmCliError):
    """Values do not fit the fields of a message."""


class BagError(ArmCliError):
    """A recording cannot be written or read."""


class RefusedError(ArmCliError):
    """A simulation answers that it cannot do what is asked for; the message is its own."""


class UnansweredError(ArmCliError):
    """Somebody who should answer does not."""


class StoppedError(Exception):
    """A signal ended the command: not an error, but the end.

    Its exit code is the signal's number, as with ros2.
    """

    def __init__(self, number: int = signal.SIGINT) -> None:
        super().__init__(f"stopped by signal {number}")
        self.exit_code = int(number)
