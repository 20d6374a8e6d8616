"""What event handlers are told, named as in ROS 2's `launch.events`."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass
from typing import TYPE_CHECKING

if TYPE_CHECKING:
    from launch_py.actions.action import Action


@dataclass(frozen=True, slots=True, kw_only=True)
class ProcessEvent:
    """Something that happened to a process.

    Attributes:
        action: the action that describes the process, as in `event.action == my_node`.
        process_name: what it is called.
        cmd: the words of its command line.
        cwd: the folder that it was given to run in, None for that of the launcher.
        env: all its environment variables; none where it could not be started.
        pid: its process id, 0 where it could not be started.
    """

    action: Action | None
    process_name: str
    cmd: tuple[str, ...]
    cwd: str | None
    env: Mapping[str, str]
    pid: int


@dataclass(frozen=True, slots=True, kw_only=True)
class ProcessStarted(ProcessEvent):
    """The process runs."""


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
