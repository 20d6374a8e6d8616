"""What event handlers are told of a process."""

from collections.abc import Callable
from typing import Any, TypeVar

from launch_py.events import ProcessExited, ProcessIO, ProcessStarted
from launch_py.supervision.member import Member

EventT = TypeVar("EventT")


def started_event(member: Member) -> ProcessStarted:
    """Return the event of the start of a process."""
    return _event(ProcessStarted, member)


def exited_event(member: Member) -> ProcessExited:
    """Return the event of the end of a process."""
    return _event(ProcessExited, member, returncode=member.exit_code)


def line_event(member: Member, stream: str, text: str) -> ProcessIO:
    """Return the event of a line that a process has written to "stdout" or "stderr"."""
    fd = 2 if stream == "stderr" else 1
    return _event(ProcessIO, member, text=f"{text}\n".encode(), fd=fd)


def _event(kind: Callable[..., EventT], member: Member, **more: Any) -> EventT:
    child, step = member.child, member.step
    return kind(
        action=step.action,
        process_name=member.name,
        cmd=tuple(map(str, step.command if child is None else child.spec.command)),
        cwd=step.cwd,
        env={} if child is None else child.spec.environment,
        pid=0 if child is None else child.pid,
        **more,
    )
