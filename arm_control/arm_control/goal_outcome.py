"""How the goal of an action ends."""

from enum import Enum


class Outcome(Enum):
    """The state in which a goal ends."""

    SUCCEEDED = "succeeded"
    ABORTED = "aborted"
    CANCELED = "canceled"
