"""`arm launch domain:=...`: the ROS domain of a launch."""

import os
from collections.abc import Iterator, Sequence
from contextlib import contextmanager

from arm_cli.output import say
from launch_py.fast_dds.participants import domain_of

WORD = "domain:="
AUTO = "auto"
VARIABLE = "ROS_DOMAIN_ID"


@contextmanager
def launch_domain(words: Sequence[str]) -> Iterator[list[str]]:
    """Take `domain:=auto` or `domain:=NUMBER` out of a launch's words, and enter that domain.

    Another value is left to the launch file, which may have an argument of that name. No
    other launch takes a domain that `auto` has found until the `with` block ends.

    Yields:
        The other words.
    """
    values = [word.removeprefix(WORD) for word in words if word.startswith(WORD)]
    value = values[-1] if values else ""
    if value != AUTO and not _is_domain(value):
        yield list(words)
        return
    others = [word for word in words if not word.startswith(WORD)]
    if value != AUTO:
        os.environ[VARIABLE] = value
        yield others
        return
    from arm_node.ros_domain import domain_of_its_own

    with domain_of_its_own() as domain:
        os.environ[VARIABLE] = str(domain)
        say(f"[launch] {VARIABLE}={domain}; export it where you start programs of your own")
        yield others


def _is_domain(text: str) -> bool:
    return text != "" and domain_of(text) is not None
