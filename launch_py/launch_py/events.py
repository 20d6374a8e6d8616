"""Events and their sources, named as in ROS 2's `launch.events`."""

from __future__ import annotations

import os
from collections.abc import Callable, Mapping
from dataclasses import dataclass
from typing import Any, ClassVar


class LaunchDescriptionEntity:
    """A part of a launch description, as plans and events refer to it; see `Action`."""

    def describe(self) -> str:
        """Return its name in messages."""
        return f"a {type(self).__name__}"


class Event:
    """Base class of all events; a launch file may derive its own and emit them."""

    name: ClassVar[str] = "launch.Event"


@dataclass(frozen=True, kw_only=True)
class ProcessEvent(Event):
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


RunningProcessEvent = ProcessEvent
"""ROS's name."""


@dataclass(frozen=True, kw_only=True)
class ProcessStarted(ProcessEvent):
    """The process has started."""

    name: ClassVar[str] = "launch.events.process.ProcessStarted"


@dataclass(frozen=True, kw_only=True)
class ProcessExited(ProcessEvent):
    """The process has ended and will not be restarted; a signal counts as 128 + its number."""

    name: ClassVar[str] = "launch.events.process.ProcessExited"
    returncode: int


@dataclass(frozen=True, kw_only=True)
class ProcessIO(ProcessEvent):
    """The process has written a line; `text` is that line with its newline, `fd` 1 or 2."""

    name: ClassVar[str] = "launch.events.process.ProcessIO"
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


class ProcessStdout(ProcessIO):
    """A line on stdout."""

    name: ClassVar[str] = "launch.events.process.ProcessStdout"


class ProcessStderr(ProcessIO):
    """A line on stderr."""

    name: ClassVar[str] = "launch.events.process.ProcessStderr"


@dataclass(frozen=True)
class ShutdownEvent(Event):
    """The shutdown begins; see `EmitEvent` and `OnShutdown`."""

    name: ClassVar[str] = "launch.events.Shutdown"
    reason: str = "the launch file asks for it"


Shutdown = ShutdownEvent
"""ROS's name, which the action that emits it has, too."""


@dataclass(frozen=True, kw_only=True)
class ExecutionComplete(Event):
    """An action is done; a process has ended for good."""

    name: ClassVar[str] = "launch.events.ExecutionComplete"
    action: LaunchDescriptionEntity | None


@dataclass(frozen=True)
class IncludeEvent(Event):
    """Emit it to run another launch description."""

    name: ClassVar[str] = "launch.events.IncludeLaunchDescription"
    launch_description: Any


IncludeLaunchDescription = IncludeEvent
"""ROS's name, which an action has, too."""


@dataclass(frozen=True, kw_only=True)
class TimerEvent(Event):
    """The time of a `TimerAction` has come."""

    name: ClassVar[str] = "launch.events.TimerEvent"
    timer_action: LaunchDescriptionEntity


ActionMatcher = Callable[[Any], bool]


@dataclass(frozen=True, slots=True)
class ProcessMatcher:
    """Tells the processes that an event is for by what they run, not by their actions."""

    fits: Callable[[ProcessEvent], bool]


@dataclass(frozen=True, kw_only=True)
class ProcessTargetedEvent(Event):
    """Emit it to do something to the processes that the matcher fits: those of which it is true.

    The matcher is called with the process's action, unless it is one of those below.
    """

    process_matcher: ActionMatcher | ProcessMatcher

    def concerns(self, process: ProcessEvent) -> bool:
        """Return whether the matcher fits a process."""
        if isinstance(self.process_matcher, ProcessMatcher):
            return self.process_matcher.fits(process)
        return process.action is not None and bool(self.process_matcher(process.action))


@dataclass(frozen=True, kw_only=True)
class ShutdownProcess(ProcessTargetedEvent):
    """Stops the processes as the shutdown does: SIGINT, later SIGTERM and SIGKILL."""

    name: ClassVar[str] = "launch.events.process.ShutdownProcess"


@dataclass(frozen=True, kw_only=True)
class SignalProcess(ProcessTargetedEvent):
    """Sends a signal, such as "SIGUSR1" or its number, to the processes."""

    name: ClassVar[str] = "launch.events.process.SignalProcess"
    signal_number: int | str


def matches_action(action: LaunchDescriptionEntity) -> ActionMatcher:
    """Return a matcher of one action's processes."""
    return lambda other: other is action


def matches_name(name: str) -> ProcessMatcher:
    """Return a matcher of the process of this name."""
    return ProcessMatcher(lambda process: process.process_name == name)


def matches_pid(pid: int) -> ProcessMatcher:
    """Return a matcher of the process with this id."""
    return ProcessMatcher(lambda process: process.pid == pid)


def matches_executable(executable: str) -> ProcessMatcher:
    """Return a matcher of the processes that run a program of this name."""
    return ProcessMatcher(lambda process: os.path.basename(process.cmd[0]) == executable)
