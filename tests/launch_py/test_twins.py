"""launch_py imports nothing of the suite, so two functions of `arm_node` stand there, too."""

import sys

import pytest

from arm_node import names, printable
from launch_py import near_names
from launch_py import printable as launch_printable

WORDS = ("joint_states", "j0p_controller", "j1p_controller", "grops", "ros2", "abc", "cab", "x")


@pytest.mark.parametrize("name", [*WORDS, "joint_stats", "controller", "bca", "zzz", ""])
@pytest.mark.parametrize("known", [(), WORDS, [f"name{i}" for i in range(16)]])
def test_what_exists_instead_of_a_name_is_said_alike(name, known):
    assert near_names.describe_known(name, known) == names.describe_known(name, known)
    assert near_names.describe_known(name, known, "it has") == names.describe_known(
        name, known, "it has"
    )


def test_each_character_is_shown_alike():
    every = "".join(map(chr, range(sys.maxunicode + 1)))
    for function in ("printable", "printable_message"):
        for text in (every, "a\n  b\nc\x1b[31md"):
            theirs, ours = getattr(launch_printable, function), getattr(printable, function)
            assert theirs(text) == ours(text)
