"""The events that event handlers receive, named as in ROS 2's `launch.events`."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass

from launch_py.launch_description_entity import LaunchDescriptionEntity


@dataclass(frozen=True, slots=True, kw_only=True)
class ProcessEvent:
    """An event of a process.

    Attributes:
        action: the action that describes the process, as in `event.action == my_node`.
        process_name: the process's name.
        cmd: the words of its command line.
        cwd: its working folder, None for the launcher's.
        env: all its environment variables; empty if it could not be started.
        pid: its process id, 0 if it could not be started.
    """

    action: LaunchDescriptionEntity | None
    process_name: str
    cmd: tuple[str, ...]
    cwd: str | None
    env: Mapping[str, str]
    pid: int


@dataclass(frozen=True, slots=True, kw_only=True)
class ProcessStarted(ProcessEvent):
    """The process has started."""


@dataclass(frozen=True, slots=True, kw_only=True)
class ProcessExited(ProcessEvent):
    """The process has ended and will not be restarted; a signal counts as 128 + its number."""

    returncode: int


@dataclass(frozen=True, slots=True, kw_only=True)
class ProcessIO(ProcessEvent):
    """The process has written a line; `text` is that line with its newline, `fd` 1 or 2."""

    text: bytes
    fd: int

    @property
    def from_stdout(self) -> bool:
        """Whether the line was written to stdout; always true on a pseudo terminal."""
        return self.fd == 1

    @property
    def from_stderr(self) -> bool:
        """Whether the line was written to stderr."""
        return self.fd == 2


@dataclass(frozen=True, slots=True)
class Shutdown:
    """The shutdown begins; see `EmitEvent` and `OnShutdown`."""

    reason: str = "the launch file asks for it"
