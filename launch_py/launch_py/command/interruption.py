"""Handles stop signals that arrive before anything is started."""

from __future__ import annotations

import signal
import sys
from collections.abc import Iterator
from contextlib import contextmanager
from types import FrameType


class Interruption:
    """Raises KeyboardInterrupt at a stop signal, as Python does at Ctrl-C, and remembers it.

    Interrupted code often raises another error instead: numpy's import an ImportError, argparse an
    AttributeError. Other code continues as if nothing had happened. So code that catches an error
    checks `came`, and code that is about to start something calls `check`.

    Python drops an exception in a callback of a weak reference or in `__del__`, and prints it as
    "Exception ignored in ...". Imports run many such callbacks. A dropped KeyboardInterrupt is not
    printed.
    """

    def __init__(self) -> None:
        self.came = False

    def __call__(self, number: int, frame: FrameType | None) -> None:
        """Handle a signal."""
        self.came = True
        signal.default_int_handler(number, frame)

    @contextmanager
    def at(self, *numbers: signal.Signals) -> Iterator[None]:
        """Handle these signals inside, except those that are ignored, as under nohup.

        A handler that other code installs meanwhile stays.
        """
        before = {number: signal.getsignal(number) for number in numbers}
        before = {n: handler for n, handler in before.items() if handler is not signal.SIG_IGN}
        for number in before:
            signal.signal(number, self)
        hook = sys.unraisablehook

        def report_unraisable(unraisable: sys.UnraisableHookArgs) -> None:
            if not (self.came and issubclass(unraisable.exc_type, KeyboardInterrupt)):
                hook(unraisable)

        sys.unraisablehook = report_unraisable
        try:
            yield
        finally:
            sys.unraisablehook = hook
            for number, handler in before.items():
                if signal.getsignal(number) is self:
                    signal.signal(number, handler)

    def check(self) -> None:
        """Raise KeyboardInterrupt if a signal has arrived and its exception was lost."""
        if self.came:
            raise KeyboardInterrupt
