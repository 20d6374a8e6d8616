"""When an ended process is started again, after what delay, and when to give up."""

from collections.abc import Callable
from dataclasses import dataclass
from typing import Literal

from launch_py.errors import LaunchFileError
from launch_py.seconds import check_seconds

RestartWhen = Literal["never", "on-failure", "always"]


@dataclass(frozen=True, slots=True)
class RestartPolicy:
    """Whether and how a process is restarted.

    The first restart waits `first_delay_s`, each further one `factor` times longer up to
    `max_delay_s`; a run longer than `within_s` makes the delay short again. After
    `give_up_after` failures within `within_s` the process is left ended: a crash loop.
    `max_restarts` limits restarts of any kind; None is no limit.
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
        """Leave an ended process ended."""
        return cls("never")

    @classmethod
    def on_failure(cls) -> "RestartPolicy":
        """Restart what ended with an exit code other than 0 or by a signal."""
        return cls("on-failure")

    @classmethod
    def always(cls) -> "RestartPolicy":
        """Restart whatever ended."""
        return cls("always")


@dataclass(frozen=True, slots=True)
class RestartDecision:
    """What follows an end: a restart after `delay_s`, or none, with the reason for giving up."""

    delay_s: float | None = None
    gave_up: str | None = None


class RestartHistory:
    """Applies a `RestartPolicy` to the ends of one process; belongs to one thread."""

    def __init__(self, policy: RestartPolicy, clock: Callable[[], float]) -> None:
        self._policy = policy
        self._clock = clock
        self._started_s = clock()
        self._failures_s: list[float] = []
        self._delay_s = policy.first_delay_s
        self._restarts = 0

    def started(self) -> None:
        """Note that a run begins now."""
        self._started_s = self._clock()

    def ended(self, exit_code: int) -> RestartDecision:
        """Decide what follows a run that ends now with `exit_code`."""
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
