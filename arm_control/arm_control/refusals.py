"""Remembers why requests were refused, for services whose answer is only a bool."""

import threading

CAPACITY = 20
"""Clients that ask for nonsense for ever must not fill the memory, nor the report."""


class Refusals:
    """The last reason of each request that was refused, until the same request succeeds.

    Any thread.
    """

    def __init__(self) -> None:
        self._lock = threading.Lock()
        self._reasons: dict[tuple[str, str], str] = {}

    def note(self, request: str, name: str, reason: str) -> None:
        """Remember a refusal; the oldest ones are forgotten.

        Args:
            request: what was asked for, 'load_controller'.
            name: for what; empty where a request has no single name.
            reason: why it was not done.
        """
        with self._lock:
            self._reasons.pop((request, name), None)
            self._reasons[request, name] = " ".join(reason.split())
            if len(self._reasons) > CAPACITY:
                del self._reasons[next(iter(self._reasons))]

    def settle(self, request: str, name: str) -> None:
        """Forget a refusal, because the same request has been met."""
        with self._lock:
            self._reasons.pop((request, name), None)

    def reasons(self) -> dict[str, str]:
        """Return the reasons by '<name>.<request>', the oldest first."""
        with self._lock:
            return {
                f"{name}.{request}" if name else request: reason
                for (request, name), reason in self._reasons.items()
            }
