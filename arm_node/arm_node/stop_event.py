"""An event that a signal handler may set."""

import os
import select
import weakref

MS_PER_S = 1000.0


class StopEvent:
    """What `threading.Event` is, for a signal handler too; once set, it stays so.

    Python runs a handler in the main thread, between two steps of whatever that does. Within
    `threading.Event.wait` that may be while it holds the event's lock, and `set` in the handler
    then waits for that lock for ever. Here a pipe takes the lock's place: `set` writes to it, and
    nobody reads, so it is readable for all who wait, now and later.

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
        """Wake all who wait; a second time does nothing."""
        if not self._is_set:
            self._is_set = True
            os.write(self._writable, b"\0")

    def wait(self, timeout_s: float | None = None) -> bool:
        """Block until `set` is called; return whether it was, within the time-out in s."""
        poll = select.poll()
        poll.register(self._readable, select.POLLIN)
        return bool(poll.poll(None if timeout_s is None else timeout_s * MS_PER_S))


def _close(*descriptors: int) -> None:
    for descriptor in descriptors:
        os.close(descriptor)
