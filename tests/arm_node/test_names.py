"""Lists of names, suggestions for unknown names, and valid node names."""

import pytest

import launch_py.near_names
from arm_node.names import MAX_LISTED, MAX_OFFERED, as_node_name, describe_known, listing

MANY = [f"/topic_{n}" for n in range(MAX_OFFERED + 1)]


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
def test_near_names_come_first_then_a_list_that_is_not_too_long(name, known, hint):
    assert describe_known(name, known, "it has") == hint
    assert launch_py.near_names.describe_known(name, known, "it has") == hint


def test_a_long_list_is_cut_short_and_an_empty_one_says_so():
    names = [f"j{n}" for n in range(MAX_LISTED + 2)]
    assert listing(names[:2]) == "j0, j1"
    assert listing(names).endswith(f"j{MAX_LISTED - 1} and 2 more")
    assert listing([]) == "nothing"


@pytest.mark.parametrize(
    ("text", "name"),
    [
        ("arm", "arm"),
        ("left-arm/joint 1", "left_arm_joint_1"),
        ("6dof_arm", "_6dof_arm"),
        ("ärmel", "_rmel"),
        ("", "_"),
    ],
)
def test_what_ros_does_not_allow_becomes_an_underscore(text, name):
    assert as_node_name(text) == name
