"""Stop signals before anything is started."""

from __future__ import annotations

import signal
from collections.abc import Iterator
from contextlib import contextmanager
from types import FrameType


class Interruption:
    """Raises KeyboardInterrupt at a stop signal, as Python does at Ctrl-C, and remembers it.

    What is interrupted in its midst often makes another error of it: numpy's import an ImportError,
    argparse an AttributeError. Some go on as if nothing had come. So whoever catches an error looks
    at `came`, and whoever is about to start something calls `check`.
    """

    def __init__(self) -> None:
        self.came = False

    def __call__(self, number: int, frame: FrameType | None) -> None:
        """Handle a signal."""
        self.came = True
        signal.default_int_handler(number, frame)

    @contextmanager
    def at(self, *numbers: signal.Signals) -> Iterator[None]:
        """Handle these signals inside, but those that are ignored, as under nohup.

        Whoever takes them over in the meantime keeps them.
        """
        before = {number: signal.getsignal(number) for number in numbers}
        before = {n: handler for n, handler in before.items() if handler is not signal.SIG_IGN}
        for number in before:
            signal.signal(number, self)
        try:
            yield
        finally:
            for number, handler in before.items():
                if signal.getsignal(number) is self:
                    signal.signal(number, handler)

    def check(self) -> None:
        """Raise KeyboardInterrupt if a signal came that was lost on the way."""
        if self.came:
            raise KeyboardInterrupt
