"""Say how far the build is; pip shows it with ``-v``."""

from typing import TextIO


class Progress:
    """Writes one line per step to a stream."""

    def __init__(self, stream: TextIO) -> None:
        """Write to ``stream``, flushing each line so that a pipe shows it at once."""
        self._stream = stream

    def say(self, sentence: str) -> None:
        """Write a line of its own."""
        self._stream.write(f"arm_interfaces: {sentence}\n")
        self._stream.flush()

    def report(self, label: str, done: int, total: int) -> None:
        """Write what was done and how far that is."""
        self.say(f"[{100 * done // total:3d} %] {label}")
