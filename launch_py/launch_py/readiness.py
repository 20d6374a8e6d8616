"""What a process must have shown before those that depend on it start.

Each condition is a value; who watches it is decided by its kind: the output of the process
(`LogLine`), its notifications (`Notified`), its end (`ProcessExited`), or the probe process
(the others: it alone talks to ROS and HTTP, so the supervisor stays small and single-threaded).
"""

from __future__ import annotations

import re
from abc import ABC, abstractmethod
from collections.abc import Callable
from dataclasses import dataclass, replace

from launch_py.errors import LaunchFileError
from launch_py.names import graph_name
from launch_py.seconds import check_seconds
from launch_py.substitution import Text

DEFAULT_TIMEOUT_S = 60.0


@dataclass(frozen=True, slots=True, kw_only=True)
class Readiness(ABC):
    """A condition of readiness that must hold within `timeout_s` of the start."""

    timeout_s: float = DEFAULT_TIMEOUT_S

    def __post_init__(self) -> None:
        check_seconds(self.timeout_s, f"timeout_s of a {type(self).__name__}")

    @abstractmethod
    def missing(self) -> str:
        """Return what is missing while the condition does not hold, as part of a sentence."""

    def resolve(self, perform: Callable[[Text], str], namespace: str) -> Readiness:
        """Return the condition with its texts performed and relative names in `namespace`.

        Raises:
            LaunchFileError: a text is not what it should be, so the condition could never hold.
        """
        return self


@dataclass(frozen=True, slots=True)
class LogLine(Readiness):
    """A line of the process's own output in which the regular expression is found."""

    pattern: str

    def __post_init__(self) -> None:
        Readiness.__post_init__(self)
        try:
            re.compile(self.pattern)
        except re.error as error:
            raise LaunchFileError(
                f"LogLine({self.pattern!r}) is not a regular expression: {error}"
            ) from error

    def missing(self) -> str:
        """Return what is missing."""
        return f"no line in its output matches {self.pattern!r}"


@dataclass(frozen=True, slots=True)
class Notified(Readiness):
    """The process says so itself: READY=1 on NOTIFY_SOCKET, as services under systemd do."""

    def missing(self) -> str:
        """Return what is missing."""
        return "it has not sent READY=1 to NOTIFY_SOCKET"


@dataclass(frozen=True, slots=True)
class ProcessExited(Readiness):
    """The process has done its work and ended with this exit code, as a spawner does."""

    code: int = 0

    def missing(self) -> str:
        """Return what is missing."""
        return f"it has not ended with exit code {self.code}"


@dataclass(frozen=True, slots=True)
class Probe(Readiness):
    """A condition that the probe process watches from outside."""


@dataclass(frozen=True, slots=True)
class TopicPublished(Probe):
    """The topic has a publisher (of `type`, if given), or has brought a first message."""

    topic: Text
    type: str | None = None
    first_message: bool = False

    def missing(self) -> str:
        """Return what is missing."""
        what = f" of type {self.type}" if self.type else ""
        return (
            f"no message{what} on topic {self.topic}"
            if self.first_message
            else f"no publisher{what} on topic {self.topic}"
        )

    def resolve(self, perform: Callable[[Text], str], namespace: str) -> Readiness:
        """Return the condition with its text performed."""
        return replace(self, topic=graph_name(namespace, perform(self.topic)))


@dataclass(frozen=True, slots=True)
class ServiceAvailable(Probe):
    """A server answers to this service name."""

    service: Text

    def missing(self) -> str:
        """Return what is missing."""
        return f"no server of service {self.service}"

    def resolve(self, perform: Callable[[Text], str], namespace: str) -> Readiness:
        """Return the condition with its text performed."""
        return replace(self, service=graph_name(namespace, perform(self.service)))


@dataclass(frozen=True, slots=True)
class ActionAvailable(Probe):
    """A server answers to this action name."""

    action: Text

    def missing(self) -> str:
        """Return what is missing."""
        return f"no server of action {self.action}"

    def resolve(self, perform: Callable[[Text], str], namespace: str) -> Readiness:
        """Return the condition with its text performed."""
        return replace(self, action=graph_name(namespace, perform(self.action)))


@dataclass(frozen=True, slots=True)
class HttpOk(Probe):
    """A GET of this URL answers 200."""

    url: Text

    def missing(self) -> str:
        """Return what is missing."""
        return f"no answer 200 from {self.url}"

    def resolve(self, perform: Callable[[Text], str], namespace: str) -> Readiness:
        """Return the condition with its text performed."""
        url = perform(self.url)
        if not url.startswith(("http://", "https://")):
            raise LaunchFileError(f"HttpOk({url!r}): a page's URL begins with http:// or https://")
        return replace(self, url=url)
