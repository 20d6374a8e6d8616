"""`launch.logging` for launch files: loggers whose messages are shown in the terminal."""

from __future__ import annotations

import logging
import sys

ROOT = "launch"


class _ShownHandler(logging.Handler):
    """Writes to whatever stdout is at the time, as the launcher's own messages go there."""

    def emit(self, record: logging.LogRecord) -> None:
        """Write one message."""
        level = f"[{record.levelname}] " if record.levelno != logging.INFO else ""
        sys.stdout.write(f"[{record.name}] {level}{record.getMessage()}\n")
        sys.stdout.flush()


def get_logger(name: str | None = None) -> logging.Logger:
    """Return a logger below "launch"; it shows what is INFO or above."""
    root = logging.getLogger(ROOT)
    if not root.handlers:
        root.addHandler(_ShownHandler())
        root.setLevel(logging.INFO)
        root.propagate = False
    inner = (name or "").removeprefix(f"{ROOT}.")
    return root.getChild(inner) if inner and inner != ROOT else root
