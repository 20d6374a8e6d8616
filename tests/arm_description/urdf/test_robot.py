"""The Robot model made without a text: look-ups, order, mimic chains, and that it is a tree."""

import dataclasses

import numpy as np
import pytest

from arm_description import Joint, Link, Mimic, MimicCycleError, Pose, Robot, UrdfError
from arm_description.urdf.robot import resolve_leader


def robot() -> Robot:
    """Return a trunk `a` with the branches b-d and c, joints not in the tree's order."""
    return Robot(
        "r",
        tuple(Link(name) for name in "abcd"),
        (
            Joint("bd", "fixed", "b", "d"),
            Joint("ac", "prismatic", "a", "c"),
            Joint("ab", "continuous", "a", "b"),
        ),
    )


def test_links_and_joints_are_found_by_name():
    assert robot().link("c") == Link("c")
    assert robot().joint("ac").type == "prismatic"


def test_an_unknown_name_is_answered_with_those_that_exist():
    with pytest.raises(UrdfError, match=r"^no joint 'j9'; the robot has bd, ac, ab$"):
        robot().joint("j9")
    with pytest.raises(UrdfError, match=r"^no link 'x'; the robot has a, b, c, d$"):
        robot().link("x")


def test_an_error_about_a_robot_of_one_link_says_that_it_has_no_joints():
    with pytest.raises(UrdfError, match=r"^no joint 'j'; the robot has nothing$"):
        Robot("r", (Link("a"),), ()).joint("j")


def test_children_are_the_joints_below_a_link():
    assert [joint.name for joint in robot().children("a")] == ["ac", "ab"]
    assert robot().children("d") == ()
    with pytest.raises(UrdfError, match="no link 'x'"):
        robot().children("x")


def test_movable_joints_are_in_the_documents_order():
    assert [joint.name for joint in robot().movable_joints] == ["ac", "ab"]


def test_in_the_trees_order_each_joint_follows_the_one_that_carries_it():
    assert [joint.name for joint in robot().joints_in_tree_order] == ["ac", "ab", "bd"]


def test_a_robot_cannot_be_changed_and_has_no_room_for_more():
    with pytest.raises(dataclasses.FrozenInstanceError):
        robot().name = "s"  # pyright: ignore[reportAttributeAccessIssue]
    assert not hasattr(robot(), "__dict__")


def test_equal_robots_are_equal():
    assert robot() == robot()


def test_links_that_do_not_form_a_tree_are_refused():
    with pytest.raises(UrdfError, match="one root link"):
        Robot("r", (Link("a"), Link("b")), ())
    with pytest.raises(UrdfError, match="no links"):
        Robot("r", (), ())


def test_a_chain_of_mimics_that_ends_is_accepted():
    links = tuple(Link(name) for name in "abcd")
    joints = (
        Joint("x", "continuous", "a", "b", mimic=Mimic("y")),
        Joint("y", "continuous", "b", "c", mimic=Mimic("z")),
        Joint("z", "fixed", "c", "d"),
    )
    assert len(Robot("r", links, joints).joints) == 3


def test_a_circle_of_mimics_behind_a_chain_is_refused():
    links = tuple(Link(name) for name in "abcd")
    joints = (
        Joint("x", "continuous", "a", "b", mimic=Mimic("y")),
        Joint("y", "continuous", "b", "c", mimic=Mimic("z")),
        Joint("z", "continuous", "c", "d", mimic=Mimic("y")),
    )
    with pytest.raises(MimicCycleError, match="y -> z -> y"):
        Robot("r", links, joints)


def test_a_pose_is_a_transform():
    matrix = Pose((1.0, 2.0, 3.0), (0.0, 0.0, np.pi / 2)).matrix()
    assert np.allclose(matrix @ [1, 0, 0, 1], [1, 3, 3, 1])


CHAIN = {"c": Mimic("b", 2.0, 1.0), "b": Mimic("a", -3.0, 0.5)}


def test_a_chain_is_one_rule():
    # c = 2 b + 1 = 2 (-3 a + 0.5) + 1
    assert resolve_leader("c", CHAIN) == Mimic("a", -6.0, 2.0)


def test_the_nearest_known_joint_leads():
    assert resolve_leader("c", CHAIN, known={"b"}) == Mimic("b", 2.0, 1.0)
    assert resolve_leader("c", CHAIN, known={"c", "b"}) == Mimic("c")


def test_a_joint_that_mimics_no_other_is_its_own_leader():
    assert resolve_leader("a", CHAIN) == Mimic("a")


def test_a_circle_is_reported_in_full():
    with pytest.raises(MimicCycleError, match=r"\['b', 'a', 'b'\]"):
        resolve_leader("b", {"a": Mimic("b"), "b": Mimic("a")})
