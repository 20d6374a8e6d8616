"""Errors of arm_controller.

    ArmControllerError
    ├── PoseError            a pose that the arm cannot take
    ├── CommandLineError     a typed line that is not a pose
    ├── PoseFileError        a file of poses that cannot be used
    ├── DeliveryError        a command without a subscriber
    ├── PlanError            an object that the arm cannot pick up at its place
    └── PickError            a pick that failed

Every message is a sentence for the user.
"""


class ArmControllerError(Exception):
    """Root of this package's errors."""


class PoseError(ArmControllerError):
    """A pose has the wrong length, is not finite, or exceeds a joint's limits."""


class CommandLineError(ArmControllerError):
    """A typed line does not contain one number for each joint."""


class PoseFileError(ArmControllerError):
    """A file of poses is missing, unreadable or invalid; the message names file and line."""


class DeliveryError(ArmControllerError):
    """A command was not published because it had no subscriber for too long."""


class PlanError(ArmControllerError):
    """The arm has no path for the task; the message says why."""


class PickError(ArmControllerError):
    """A step of a pick failed; the message says which and why."""
