"""An event that a signal handler may set."""

import os
import select
import weakref

MS_PER_S = 1000.0


class StopEvent:
    """Like `threading.Event`, but safe in signal handlers; once set, it stays set.

    Python runs a handler in the main thread, between two steps of the code there. Within
    `threading.Event.wait` that may be while it holds the event's lock, and `set` in the handler
    would then wait for that lock for ever. Here a pipe replaces the lock: `set` writes to it, and
    no thread reads from it, so it is readable for all waiting threads, now and later.

    Every method may be called from any thread and from a signal handler.
    """

    def __init__(self) -> None:
        """Open the pipe; it is closed with the last reference to this object."""
        self._readable, self._writable = os.pipe()
        os.set_blocking(self._writable, False)
        self._is_set = False
        weakref.finalize(self, _close, self._readable, self._writable)

    def is_set(self) -> bool:
        """Return whether `set` was called."""
        return self._is_set

    def set(self) -> None:
        """Wake all waiting threads; a second call does nothing."""
        if not self._is_set:
            self._is_set = True
            os.write(self._writable, b"\0")

    def wait(self, timeout_s: float | None = None) -> bool:
        """Block until `set` is called; return whether it was, within the timeout in s."""
        poll = select.poll()
        poll.register(self._readable, select.POLLIN)
        return bool(poll.poll(None if timeout_s is None else timeout_s * MS_PER_S))


def _close(*descriptors: int) -> None:
    for descriptor in descriptors:
        os.close(descriptor)
