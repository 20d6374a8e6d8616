"""The reasons for refusing a request to the running world."""

from enum import Enum, auto

from arm_gazebo.errors import GazeboError


class Refusal(Enum):
    """The kinds of refusal that result codes distinguish."""

    UNSUPPORTED = auto()
    NOT_FOUND = auto()
    INCORRECT_STATE = auto()
    FAILED = auto()
    NAME_NOT_UNIQUE = auto()
    NAME_INVALID = auto()
    NAMESPACE_INVALID = auto()
    UNSUPPORTED_FORMAT = auto()
    NO_RESOURCE = auto()
    UNREADABLE = auto()
    MISSING_ASSETS = auto()
    UNSUPPORTED_ELEMENTS = auto()
    INVALID_POSE = auto()
    NO_WORLD = auto()
    ALREADY_THERE = auto()
    INCORRECT_TRANSITION = auto()


class RequestError(GazeboError):
    """A request to the running world is refused; nothing was changed.

    Attributes:
        refusal: the kind; the message is for the user.
    """

    def __init__(self, refusal: Refusal, message: str) -> None:
        super().__init__(message)
        self.refusal = refusal
