"""Restart policies: whether to restart a process that has ended, when, and when to give up."""

from collections.abc import Callable
from dataclasses import dataclass
from typing import Literal

from launch_py.errors import LaunchFileError
from launch_py.typed_values import check_seconds

RestartWhen = Literal["never", "on-failure", "always"]


@dataclass(frozen=True, slots=True)
class RestartPolicy:
    """Whether and how a process is restarted.

    The first restart waits `first_delay_s`. Each further restart waits `factor` times longer, up to
    `max_delay_s`. A run longer than `within_s` resets the delay. After `give_up_after` failures
    within `within_s` the process counts as crash-looping and is not restarted. `max_restarts`
    limits the number of restarts for any reason; None means no limit.
    """

    when: RestartWhen = "never"
    first_delay_s: float = 0.5
    factor: float = 2.0
    max_delay_s: float = 8.0
    give_up_after: int = 5
    within_s: float = 30.0
    max_restarts: int | None = None

    def __post_init__(self) -> None:
        if self.when not in ("never", "on-failure", "always"):
            raise LaunchFileError(
                f"a restart policy is never, on-failure or always, not {self.when!r}"
            )
        for name in ("first_delay_s", "max_delay_s", "within_s"):
            check_seconds(getattr(self, name), f"{name} of a RestartPolicy")

    @classmethod
    def never(cls) -> "RestartPolicy":
        """Never restart."""
        return cls("never")

    @classmethod
    def on_failure(cls) -> "RestartPolicy":
        """Restart after an exit code other than 0 and after a signal."""
        return cls("on-failure")

    @classmethod
    def always(cls) -> "RestartPolicy":
        """Restart after every exit."""
        return cls("always")


@dataclass(frozen=True, slots=True)
class RestartDecision:
    """A restart after `delay_s`, or no restart, with the reason if the policy gave up."""

    delay_s: float | None = None
    gave_up: str | None = None


class RestartHistory:
    """Applies a `RestartPolicy` to one process; belongs to one thread."""

    def __init__(self, policy: RestartPolicy, clock: Callable[[], float]) -> None:
        self._policy = policy
        self._clock = clock
        self._started_s = clock()
        self._failures_s: list[float] = []
        self._delay_s = policy.first_delay_s
        self._restarts = 0

    def started(self) -> None:
        """Record that a run starts now."""
        self._started_s = self._clock()

    def ended(self, exit_code: int) -> RestartDecision:
        """Decide whether to restart after a run that ends now with `exit_code`."""
        policy = self._policy
        if policy.when == "never" or (policy.when == "on-failure" and exit_code == 0):
            return RestartDecision()
        now_s = self._clock()
        if exit_code != 0:
            recent = [t for t in self._failures_s if now_s - t < policy.within_s]
            self._failures_s = [*recent, now_s]
            if len(self._failures_s) >= policy.give_up_after:
                return RestartDecision(
                    gave_up=f"it failed {len(self._failures_s)} times within "
                    f"{policy.within_s:g} s, the last time with exit code {exit_code}"
                )
        if policy.max_restarts is not None and self._restarts >= policy.max_restarts:
            return RestartDecision(gave_up=f"it was restarted {self._restarts} times already")
        if now_s - self._started_s > policy.within_s:
            self._delay_s = policy.first_delay_s
        delay_s = self._delay_s
        self._delay_s = min(delay_s * policy.factor, policy.max_delay_s)
        self._restarts += 1
        return RestartDecision(delay_s=delay_s)
