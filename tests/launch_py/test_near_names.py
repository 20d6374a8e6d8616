"""The hint for a name that does not exist."""

import pytest

from launch_py.near_names import MAX_LISTED, describe_known

MANY = [f"/topic_{n}" for n in range(MAX_LISTED + 1)]


@pytest.mark.parametrize(
    ("name", "known", "hint"),
    [
        ("ech", ["echo", "hz"], "did you mean 'echo'?"),
        ("states", ["/left/joint_states", "/tf"], "did you mean '/left/joint_states'?"),
        ("ros2", ["grops", "rosidl", "groups"], "it has grops, groups, rosidl"),
        ("lsit", ["list"], "did you mean 'list'?"),
        ("whatever", ["at", "w"], "it has at, w"),
        ("zzz", ["b", "a", "b"], "it has a, b"),
        ("zzz", [], "it has none"),
        ("zzz", MANY, f"none of the {len(MANY)} has a similar name"),
    ],
)
def test_similar_names_come_before_a_short_list_of_all_names(name, known, hint):
    assert describe_known(name, known, "it has") == hint
