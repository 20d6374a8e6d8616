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
class Shutdown:
    """Everything is to stop; see `EmitEvent`."""

    reason: str = "the launch file asks for it"
