"""Errors of arm_controller.

    ArmControllerError
    ├── PoseError            a pose that the arm cannot take
    ├── CommandLineError     a typed line that is no pose
    ├── PoseFileError        a file of poses that cannot be used
    ├── DeliveryError        nobody took a command
    ├── ParameterValueError  a node parameter that makes no sense
    ├── PlanError            what shall be picked up cannot be, from where it stands
    └── PickError            a pick that did not come off

Every message is a sentence for the user.
"""


class ArmControllerError(Exception):
    """Root of this package's errors."""


class PoseError(ArmControllerError):
    """A pose has the wrong length, is not finite, or lies beyond a joint's limits."""


class CommandLineError(ArmControllerError):
    """A line typed at the prompt is not a list of as many numbers as there are joints."""


class PoseFileError(ArmControllerError):
    """A file of poses is missing, unreadable or wrong; the message names file and line."""


class DeliveryError(ArmControllerError):
    """A command was not published because nobody listened for too long."""


class ParameterValueError(ArmControllerError):
    """A parameter of a node has a value that the node cannot work with."""


class PlanError(ArmControllerError):
    """There is no way for the arm to do what it shall; the message says why."""


class PickError(ArmControllerError):
    """A step of a pick failed; the message says which and why."""
