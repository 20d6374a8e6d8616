"""Errors of the command line; every message is a sentence for the user.

ArmCliError
|-- CommandUsageError       the command's arguments are wrong
|-- NoSuchNameError         no such topic, node, service, type, file, ...
|-- MessageError            values do not fit a message's fields
|-- BagError                a recording cannot be written or read
|-- MotionFailedError       a motion was not planned, or not executed
|-- SimulationRefusedError  a simulation refuses a request
`-- UnansweredError         a node does not answer
"""

import signal


class ArmCliError(Exception):
    """Base class; the message is one sentence for the user."""

    exit_code = 1


class CommandUsageError(ArmCliError):
    """The command's arguments are wrong."""

    exit_code = 2


class NoSuchNameError(ArmCliError):
    """A name does not exist; the message says which names do."""


class MessageError(ArmCliError):
    """Values do not fit the fields of a message."""


class BagError(ArmCliError):
    """A recording cannot be written or read."""


class SimulationRefusedError(ArmCliError):
    """A simulation refuses a request; the message is the simulation's."""


class MotionFailedError(ArmCliError):
    """A motion was not planned, or not executed; the message is move_group's."""


class UnansweredError(ArmCliError):
    """A node does not answer."""


class StoppedError(Exception):
    """A signal ended the command, which is not an error.

    The exit code is the signal's number, as with ros2.
    """

    def __init__(self, number: int = signal.SIGINT) -> None:
        super().__init__(f"stopped by signal {number}")
        self.exit_code = int(number)
