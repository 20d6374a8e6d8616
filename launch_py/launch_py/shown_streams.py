"""Which streams of a process `output=` puts on the screen; the log files always get both."""

from __future__ import annotations

from collections.abc import Iterable, Mapping
from typing import TYPE_CHECKING, Any

from launch_py.errors import LaunchFileError
from launch_py.near_names import describe_known
from launch_py.substitution import Text, perform_text

if TYPE_CHECKING:
    from launch_py.launch_context import LaunchContext

BOTH = frozenset({"stdout", "stderr"})

SHOWN_BY_WORD = {
    "screen": BOTH,
    "both": BOTH,
    "full": BOTH,
    "log": frozenset({"stderr"}),
    "own_log": frozenset({"stderr"}),
}
"""ROS's words; alone, those for the log leave stderr on the screen."""

STREAMS_BY_KEY = {
    "stdout": frozenset({"stdout"}),
    "stderr": frozenset({"stderr"}),
    "both": BOTH,
}

Output = Text | Mapping[Any, Any]


def perform_shown_streams(context: LaunchContext, output: Output, process: str) -> frozenset[str]:
    """Return the streams that are shown.

    Args:
        context: the scope.
        output: a word, or a dict of a word or several for "stdout", "stderr" or "both"; a stream
            that the dict does not put on the screen is in the log file only.
        process: whose output it is, for the error.

    Raises:
        LaunchFileError: a key or a word is not known.
    """
    if not isinstance(output, Mapping):
        return SHOWN_BY_WORD[_known(context, output, SHOWN_BY_WORD, f"output={{!r}} of {process}")]
    shown: frozenset[str] = frozenset()
    for key, value in output.items():
        stream = _known(context, key, STREAMS_BY_KEY, f"the key {{!r}} in output= of {process}")
        many = isinstance(value, Iterable) and not isinstance(value, str | Mapping)
        for item in value if many else (value,):
            where = f"{stream}: {{!r}} in output= of {process}"
            if "stdout" in SHOWN_BY_WORD[_known(context, item, SHOWN_BY_WORD, where)]:
                shown |= STREAMS_BY_KEY[stream]
    return shown


def _known(context: LaunchContext, value: Any, known: Iterable[str], where: str) -> str:
    """Return the word that `value` stands for; `where` names its place, with {!r} for it."""
    known = sorted(known)
    if isinstance(value, Mapping):
        raise LaunchFileError(f"{where.format(value)}: a word is needed, not a dict")
    word = perform_text(context, value)
    if word not in known:
        raise LaunchFileError(
            f"{where.format(word)}; {describe_known(word, known, 'the choices are')}"
        )
    return word
