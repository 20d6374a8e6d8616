"""Regular expressions that are found, or not, in a time that no pattern can blow up.

`re` tries the ways in which a pattern may fit one after the other. There may be 2 to the power of
the name's length, and it keeps all other threads waiting meanwhile, the control loop among them.
RE2 follows all ways at once. It takes POSIX extended expressions, those of simulation_interfaces.
"""

import re2

from arm_gazebo.world.refusal import Refusal, RefusedError

LONGEST_PATTERN = 200


class NamePattern:
    """A POSIX extended regular expression, which may have the escapes of `re`, too.

    Raises:
        RefusedError: it is none, or longer than `LONGEST_PATTERN`.
    """

    def __init__(self, pattern: str) -> None:
        if len(pattern) > LONGEST_PATTERN:
            raise RefusedError(
                Refusal.FAILED, f"the filter has more than {LONGEST_PATTERN} characters"
            )
        options = re2.Options()
        options.log_errors = False  # To stderr, which is the caller's business, not RE2's.
        try:
            self._expression = re2.compile(pattern, options)
        except (re2.error, UnicodeEncodeError) as error:
            raise RefusedError(
                Refusal.FAILED,
                f"the filter {pattern!r} is no regular expression: {_reason(error)}",
            ) from error

    def is_in(self, name: str) -> bool:
        """Return whether the pattern fits some part of a name."""
        return self._expression.search(name) is not None


def _reason(error: Exception) -> str:
    """Return what RE2 says, which is bytes."""
    [reason, *_] = error.args or ("",)
    return reason.decode("utf-8", "replace") if isinstance(reason, bytes) else str(error)
