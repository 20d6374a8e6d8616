"""The pending steps of a plan, and which of them are due."""

from __future__ import annotations

from collections.abc import Callable, Iterable

from launch_py.plan.steps import Step, Trigger, TriggerKind
from launch_py.supervision.event_loop import EventLoop


class StepSchedule:
    """Returns each step once all its triggers have happened; belongs to the loop's thread.

    Args:
        loop: the event loop, for the steps with a delay.
        has_happened: returns whether a trigger has happened.
    """

    def __init__(self, loop: EventLoop, has_happened: Callable[[Trigger], bool]) -> None:
        self._loop = loop
        self._has_happened = has_happened
        self._waiting: list[Step] = []
        self._delayed = 0

    @property
    def open(self) -> bool:
        """Whether a step is due now or after its delay."""
        return bool(self._delayed) or any(map(self._is_due, self._waiting))

    def add(self, step: Step) -> None:
        """Add a step."""
        self._waiting.append(step)

    def next_due(self) -> Step | None:
        """Remove and return the first step that is due, or None."""
        step = next(filter(self._is_due, self._waiting), None)
        if step is not None:
            self._waiting.remove(step)
        return step

    def delay(self, step: Step, take: Callable[[Step], None]) -> None:
        """Call `take` with a step that is due, after the step's delay."""
        self._delayed += 1

        def elapsed() -> None:
            self._delayed -= 1
            take(step)

        self._loop.call_later(step.delay_s, elapsed)

    def needs(self, process: str) -> bool:
        """Return whether a step waits for the start or the readiness of a process."""
        return any(
            trigger.process == process and trigger.kind is not TriggerKind.EXITED
            for step in self._waiting
            for trigger in step.after
        )

    def keep_reactions_to_exits(self) -> None:
        """Drop every step that does not wait for the end of a process."""
        self._waiting = [step for step in self._waiting if _awaits_exit(step.after)]

    def clear(self) -> None:
        """Drop every waiting step."""
        self._waiting.clear()

    def _is_due(self, step: Step) -> bool:
        return all(map(self._has_happened, step.after))


def _awaits_exit(triggers: Iterable[Trigger]) -> bool:
    return any(trigger.kind is TriggerKind.EXITED for trigger in triggers)
