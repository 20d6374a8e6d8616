"""Life-cycle states of controllers and hardware components, numbered as in lifecycle_msgs."""

from enum import IntEnum


class LifecycleState(IntEnum):
    """A primary state; the value is its id in lifecycle_msgs/msg/State."""

    UNKNOWN = 0
    UNCONFIGURED = 1
    INACTIVE = 2
    ACTIVE = 3
    FINALIZED = 4

    @property
    def label(self) -> str:
        """The state's name as clients see it."""
        return self.name.lower()
