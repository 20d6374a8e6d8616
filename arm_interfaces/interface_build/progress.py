"""Report the progress of the build; pip shows it with ``-v``."""

from typing import TextIO


class BuildProgress:
    """Writes one line per step to a stream."""

    def __init__(self, name: str, stream: TextIO) -> None:
        """Write to ``stream``, flushing each line so that it passes a pipe immediately.

        Args:
            name: the distribution's name, which begins each line.
            stream: where to write.
        """
        self._name = name
        self._stream = stream

    def say(self, sentence: str) -> None:
        """Write a line."""
        self._stream.write(f"{self._name}: {sentence}\n")
        self._stream.flush()

    def report(self, label: str, done: int, total: int) -> None:
        """Write the completed step and the percentage."""
        self.say(f"[{100 * done // total:3d} %] {label}")
