"""What a controller manager tells its observers."""

from typing import Protocol

from arm_control.lifecycle import LifecycleState, Transition


class ManagerObserver(Protocol):
    """Is told of changes on the loop thread; it must return quickly and must not raise."""

    def controller_transitioned(
        self, name: str, transition: Transition, start: LifecycleState, end: LifecycleState
    ) -> None:
        """A controller attempted a transition; `end` is the transition's goal if it succeeded."""
        ...

    def activity_changed(self) -> None:
        """The set of controllers or components, or the state of one of them, has changed."""
        ...
