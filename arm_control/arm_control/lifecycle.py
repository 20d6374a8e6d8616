"""The life cycle of controllers and hardware components, numbered as in lifecycle_msgs."""

from enum import Enum, IntEnum


class LifecycleState(IntEnum):
    """A primary state; the value is its id in lifecycle_msgs/msg/State."""

    UNCONFIGURED = 1
    INACTIVE = 2
    ACTIVE = 3
    FINALIZED = 4

    @property
    def label(self) -> str:
        """The state's name as clients see it."""
        return self.name.lower()


class Transition(Enum):
    """A transition between primary states; the value is its label.

    Attributes:
        id: in lifecycle_msgs/msg/Transition.
        state_id: id of its transition state in lifecycle_msgs/msg/State.
        state_label: name of its transition state.
        goal: the primary state that it leads to.
    """

    id: int
    state_id: int
    state_label: str
    goal: LifecycleState

    def __new__(
        cls, label: str, number: int, state_id: int, state_label: str, goal: LifecycleState
    ) -> "Transition":
        """Make a member from its row in the table below."""
        member = object.__new__(cls)
        member._value_ = label
        member.id = number
        member.state_id = state_id
        member.state_label = state_label
        member.goal = goal
        return member

    CONFIGURE = ("configure", 1, 10, "configuring", LifecycleState.INACTIVE)
    CLEANUP = ("cleanup", 2, 11, "cleaningup", LifecycleState.UNCONFIGURED)
    ACTIVATE = ("activate", 3, 13, "activating", LifecycleState.ACTIVE)
    DEACTIVATE = ("deactivate", 4, 14, "deactivating", LifecycleState.INACTIVE)
    SHUTDOWN = ("shutdown", 5, 12, "shuttingdown", LifecycleState.FINALIZED)

    @property
    def label(self) -> str:
        """Name of the transition."""
        return self.value
