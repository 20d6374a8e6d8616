"""What event handlers are told, named as in ROS 2's `launch.events`."""

from __future__ import annotations

from dataclasses import dataclass


@dataclass(frozen=True, slots=True)
class ProcessEvent:
    """Something that happened to a process."""

    process_name: str
    cmd: tuple[str, ...]
    pid: int


@dataclass(frozen=True, slots=True)
class ProcessStarted(ProcessEvent):
    """The process runs."""


@dataclass(frozen=True, slots=True)
class ProcessExited(ProcessEvent):
    """The process has ended and will not be restarted; a signal counts as 128 + its number."""

    returncode: int


@dataclass(frozen=True, slots=True)
class ProcessIO(ProcessEvent):
    """The process has written a line; `text` is that line with its newline, `fd` 1 or 2."""

    text: bytes
    fd: int

    @property
    def from_stdout(self) -> bool:
        """Whether it came on stdout, as all does of a process on a pseudo terminal."""
        return self.fd == 1

    @property
    def from_stderr(self) -> bool:
        """Whether it came on stderr."""
        return self.fd == 2


@dataclass(frozen=True, slots=True)
class Shutdown:
    """Everything is to stop; see `EmitEvent` and `OnShutdown`."""

    reason: str = "the launch file asks for it"
