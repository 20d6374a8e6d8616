"""What can be called, the user's wishes about it, and what has become of a call: frozen data."""

from collections.abc import Mapping
from dataclasses import dataclass
from enum import Enum

from arm_node.messages.text import Abridgement, to_yaml
from arm_viewer.calls.form import FormField

MAX_ANSWER = 20_000
"""Longest answer that is shown, in characters."""
MAX_LISTED = 100
"""Longest array or text in an answer."""
MIN_RATE_HZ, MAX_RATE_HZ = 0.1, 100.0


class CallKind(Enum):
    """What is called."""

    SERVICE = "service"
    ACTION = "action"
    TOPIC = "topic"
    PARAMETERS = "parameters"


@dataclass(frozen=True, slots=True)
class Callee:
    """Something that can be called.

    Attributes:
        kind: what it is.
        name: absolute name; that of the node for parameters.
        type: such as "std_srvs/srv/SetBool"; "" for parameters.
    """

    kind: CallKind
    name: str
    type: str


@dataclass(frozen=True, slots=True)
class OpenForm:
    """Find out what can be typed, before the call of that number."""

    number: int
    callee: Callee


@dataclass(frozen=True, slots=True)
class PlaceCall:
    """Call, send a goal, publish, or set parameters.

    Attributes:
        number: identifies the call.
        callee: what is called.
        typed: texts by the path of a field, or by the name of a parameter.
        rate_hz: how often a message is published; 0 for once.
    """

    number: int
    callee: Callee
    typed: Mapping[str, str]
    rate_hz: float = 0.0


@dataclass(frozen=True, slots=True)
class EndCall:
    """Cancel a goal, stop publishing, or stop waiting for an answer."""

    number: int


CallRequest = OpenForm | PlaceCall | EndCall


@dataclass(frozen=True, slots=True)
class CallState:
    """What has become of a call.

    Attributes:
        text: a sentence.
        answer: the answer, or the newest feedback, as YAML; "" before there is one.
        is_over: whether nothing more comes.
        is_failed: whether it failed.
        form: what can be typed, if that was asked.
    """

    text: str
    answer: str = ""
    is_over: bool = False
    is_failed: bool = False
    form: tuple[FormField, ...] | None = None


def failure(text: str) -> CallState:
    """Return the state of a call that has failed."""
    return CallState(text, is_over=True, is_failed=True)


def shown(message: object) -> str:
    """Return a message as YAML, as much of it as somebody reads."""
    text = to_yaml(message, Abridgement(truncate_length=MAX_LISTED))
    if len(text) <= MAX_ANSWER:
        return text
    return f"{text[:MAX_ANSWER]}\n# and {len(text) - MAX_ANSWER} characters more"
