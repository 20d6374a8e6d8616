"""Readiness conditions: what must hold before the processes that depend on a process start.

Each condition is a value. The supervisor itself checks the process's output (`LogLine`), its
notifications (`Notified`) and its exit (`Finished`). The probe process checks all others: it
alone talks to ROS and HTTP, so the supervisor stays small and single-threaded.
"""

from __future__ import annotations

import re
from abc import ABC, abstractmethod
from collections.abc import Callable
from dataclasses import dataclass, replace

from launch_py.errors import LaunchFileError
from launch_py.substitution import Text, join_names
from launch_py.typed_values import check_seconds

DEFAULT_TIMEOUT_S = 60.0

# ROS's rules: no part starts with a digit, and no name has two underscores in a row.
_FULL_NAME = re.compile(r"(?!.*__)(?:/[A-Za-z_]\w*)+", re.ASCII)


@dataclass(frozen=True, slots=True, kw_only=True)
class Readiness(ABC):
    """A readiness condition that must hold within `timeout_s` after the start."""

    timeout_s: float = DEFAULT_TIMEOUT_S

    def __post_init__(self) -> None:
        check_seconds(self.timeout_s, f"timeout_s of a {type(self).__name__}")

    @abstractmethod
    def missing(self) -> str:
        """Return why the condition does not hold yet, as a clause of a sentence."""

    def resolve(self, perform: Callable[[Text], str], namespace: str) -> Readiness:
        """Return the condition with its texts performed and relative names in `namespace`.

        Raises:
            LaunchFileError: a text is invalid, so that the condition could never hold.
        """
        return self


@dataclass(frozen=True, slots=True)
class LogLine(Readiness):
    """A line of the process's output matches the regular expression."""

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
    """The process sends READY=1 to NOTIFY_SOCKET, as services under systemd do."""

    def missing(self) -> str:
        """Return what is missing."""
        return "it has not sent READY=1 to NOTIFY_SOCKET"


@dataclass(frozen=True, slots=True)
class Finished(Readiness):
    """The process, such as a spawner, has done its work and ended with this exit code."""

    code: int = 0

    def missing(self) -> str:
        """Return what is missing."""
        return f"it has not ended with exit code {self.code}"


ProcessExited = Finished
"""The former name, which launch files may still use; launch's event has the same name."""


@dataclass(frozen=True, slots=True)
class ProbedCondition(Readiness):
    """A condition that the probe process checks."""


@dataclass(frozen=True, slots=True)
class TopicPublished(ProbedCondition):
    """The topic has a publisher (of `type`, if given), or has delivered a first message."""

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
        return replace(self, topic=_graph_name(namespace, perform(self.topic)))


@dataclass(frozen=True, slots=True)
class ServiceAvailable(ProbedCondition):
    """The service has a server."""

    service: Text

    def missing(self) -> str:
        """Return what is missing."""
        return f"no server of service {self.service}"

    def resolve(self, perform: Callable[[Text], str], namespace: str) -> Readiness:
        """Return the condition with its text performed."""
        return replace(self, service=_graph_name(namespace, perform(self.service)))


@dataclass(frozen=True, slots=True)
class ActionAvailable(ProbedCondition):
    """The action has a server."""

    action: Text

    def missing(self) -> str:
        """Return what is missing."""
        return f"no server of action {self.action}"

    def resolve(self, perform: Callable[[Text], str], namespace: str) -> Readiness:
        """Return the condition with its text performed."""
        return replace(self, action=_graph_name(namespace, perform(self.action)))


@dataclass(frozen=True, slots=True)
class HttpOk(ProbedCondition):
    """A GET request to this URL returns status 200."""

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


def _graph_name(namespace: str, name: str) -> str:
    """Return the full name of the topic, service or action `name` in `namespace`.

    Raises:
        LaunchFileError: ROS does not allow the name.
    """
    full = join_names(namespace, name) if name else ""
    if not _FULL_NAME.fullmatch(full):
        raise LaunchFileError(
            f"{name!r} is not a valid name of a topic, service or action: use letters, digits "
            "and single underscores, and separate parts by slashes; a part begins with no digit"
        )
    return full
