"""What event handlers are told of a process."""

from __future__ import annotations

from collections.abc import Mapping
from typing import TYPE_CHECKING, TypedDict

from launch_py.events import ProcessExited, ProcessIO, ProcessStarted
from launch_py.supervision.member import Member

if TYPE_CHECKING:
    from launch_py.actions.action import Action


class _Identity(TypedDict):
    """What every event tells of its process."""

    action: Action | None
    process_name: str
    cmd: tuple[str, ...]
    cwd: str | None
    env: Mapping[str, str]
    pid: int


def started_event(member: Member) -> ProcessStarted:
    """Return the event of the start of a process."""
    return ProcessStarted(**_identity(member))


def exited_event(member: Member) -> ProcessExited:
    """Return the event of the end of a process."""
    return ProcessExited(**_identity(member), returncode=member.exit_code)


def line_event(member: Member, stream: str, text: str) -> ProcessIO:
    """Return the event of a line that a process has written to "stdout" or "stderr"."""
    fd = 2 if stream == "stderr" else 1
    return ProcessIO(**_identity(member), text=f"{text}\n".encode(), fd=fd)


def _identity(member: Member) -> _Identity:
    child = member.child
    command = member.step.command if child is None else child.spec.command
    return {
        "action": member.step.action,
        "process_name": member.name,
        "cmd": tuple(map(str, command)),
        "cwd": member.step.cwd,
        "env": {} if child is None else child.spec.environment,
        "pid": 0 if child is None else child.pid,
    }
