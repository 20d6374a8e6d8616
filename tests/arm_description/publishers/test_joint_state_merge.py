"""What joint_state_publisher publishes: defaults, sources, dependences, limits and the sweep."""

import math
import re

import pytest

from arm_description import JointStateError, SettingsError, parse_urdf
from arm_description.errors import MimicCycleError
from arm_description.publishers.joint_state_merge import JointStateMerge, MergedState
from arm_description.publishers.settings import JointPublisherSettings
from arm_description.urdf.robot import Mimic

WIDE = "<limit lower='-1' upper='1' effort='1' velocity='1'/>"


def merge(*joints: tuple[str, str, str], **settings) -> JointStateMerge:
    """Return a merge for joints (name, type, inside) and settings by name."""
    text = "".join(
        f"<link name='l{n}'/><joint name='{name}' type='{kind}'><parent link='base'/>"
        f"<child link='l{n}'/>{inside}</joint>"
        for n, (name, kind, inside) in enumerate(joints)
    )
    robot = parse_urdf(f"<robot name='r'><link name='base'/>{text}</robot>")
    return JointStateMerge(robot.joints, JointPublisherSettings(**settings))


def two(**settings) -> JointStateMerge:
    return merge(("b", "revolute", WIDE), ("a", "revolute", WIDE), **settings)


def test_joints_with_one_position_are_published_in_the_documents_order():
    merged = merge(
        ("z", "revolute", WIDE),
        ("f", "fixed", ""),
        ("p", "planar", ""),
        ("g", "floating", ""),
        ("a", "continuous", ""),
        ("m", "prismatic", WIDE),
    )
    assert merged.state() == MergedState(("z", "a", "m"), (0.0, 0.0, 0.0), (), ())


@pytest.mark.parametrize(
    ("bounds", "position"),
    [((-1, 1), 0.0), ((0, 1), 0.0), ((-1, 0), 0.0), ((1, 2), 1.5), ((-4, -2), -3.0)],
)
def test_a_joint_starts_at_zero_or_in_the_middle_of_its_range(bounds, position):
    lower, upper = bounds
    limit = f"<limit lower='{lower}' upper='{upper}' effort='1' velocity='1'/>"
    assert merge(("j", "revolute", limit)).state().positions == (position,)


def test_zeros_stand_even_outside_the_limits():
    assert two(zeros={"a": 5.0, "x": 1.0}).state().positions == (0.0, 5.0)


SOFT = "<safety_controller k_velocity='1' soft_lower_limit='0.5' soft_upper_limit='9'/>"


@pytest.mark.parametrize(("use", "position"), [(True, 0.75), (False, 0.0)])
def test_soft_limits_narrow_the_range_where_wanted(use, position):
    merged = merge(("j", "revolute", WIDE + SOFT), use_smallest_joint_limits=use)
    assert merged.state().positions == (position,)


def test_defaults_are_published_as_wanted():
    merged = two(
        publish_default_positions=False,
        publish_default_velocities=True,
        publish_default_efforts=True,
    )
    assert merged.state() == MergedState(("b", "a"), (), (0.0, 0.0), (0.0, 0.0))


def test_sources_merge_by_name_and_the_latest_value_wins():
    merged = two()
    merged.merge(["a", "x"], [1.0, 9.0], [], [])
    merged.merge(["b", "a"], [2.0, 3.0], [0.1, 0.2], [])
    assert merged.state() == MergedState(("b", "a"), (2.0, 3.0), (0.1, 0.2), ())


def test_an_empty_field_of_a_source_changes_nothing():
    merged = two()
    merged.merge(["a"], [1.0], [], [])
    merged.merge(["a"], [], [], [7.0])
    assert merged.state() == MergedState(("b", "a"), (0.0, 1.0), (), (0.0, 7.0))


@pytest.mark.parametrize(
    ("values", "message"),
    [
        (([1.0], [], []), "2 names, but 1 positions"),
        (([], [1.0, 2.0, 3.0], []), "2 names, but 3 velocities"),
        (([], [], [1.0]), "2 names, but 1 efforts"),
        (([1.0, math.nan], [], []), "a position of a, b is not a finite number"),
    ],
)
def test_a_source_that_makes_no_sense_is_refused_whole(values, message):
    merged = two()
    with pytest.raises(JointStateError, match=message):
        merged.merge(["a", "b"], *values)
    assert merged.state().positions == (0.0, 0.0)


def test_a_mimic_follows_with_factor_and_offset_but_not_in_effort():
    mimic = "<mimic joint='a' multiplier='-2' offset='0.5'/>"
    merged = merge(("m", "continuous", mimic), ("a", "continuous", ""))
    merged.merge(["a", "m"], [1.0, 9.0], [3.0, 9.0], [4.0, 9.0])
    assert merged.state() == MergedState(("m", "a"), (-1.5, 1.0), (-6.0, 3.0), (4.0, 4.0))


def test_chains_of_mimics_compose():
    merged = merge(
        ("c", "continuous", "<mimic joint='b' multiplier='2' offset='1'/>"),
        ("b", "continuous", "<mimic joint='a' multiplier='3' offset='0.5'/>"),
        ("a", "continuous", ""),
    )
    merged.merge(["a"], [1.0], [], [])
    assert merged.state().positions == (8.0, 3.5, 1.0)


def test_without_mimic_tags_every_joint_is_free():
    merged = merge(
        ("m", "continuous", "<mimic joint='a'/>"), ("a", "continuous", ""), use_mimic_tags=False
    )
    merged.merge(["m"], [1.0], [], [])
    assert merged.state().positions == (1.0, 0.0)


def test_a_mimic_of_a_joint_that_cannot_move_rests_at_its_offset():
    merged = merge(("m", "continuous", "<mimic joint='f' offset='0.5'/>"), ("f", "fixed", ""))
    assert merged.state().positions == ()
    merged = merge(
        ("m", "continuous", "<mimic joint='f' offset='0.5'/>"),
        ("f", "fixed", ""),
        ("a", "continuous", ""),
    )
    assert merged.state().positions == (0.5, 0.0)


def test_dependent_joints_of_the_parameters_follow():
    merged = two(dependent_joints={"b": Mimic("a", 2.0, 0.25)})
    merged.merge(["a"], [1.0], [], [])
    assert merged.state().positions == (2.25, 1.0)


def test_a_mimic_tag_overrides_a_dependence_in_the_parameters():
    merged = merge(
        ("m", "continuous", "<mimic joint='a' multiplier='3'/>"),
        ("a", "continuous", ""),
        dependent_joints={"m": Mimic("a", 2.0)},
    )
    merged.merge(["a"], [1.0], [], [])
    assert merged.state().positions == (3.0, 1.0)


def test_dependences_in_a_circle_are_refused():
    dependences = {"b": Mimic("a"), "a": Mimic("b")}
    chain = re.escape("Found an infinite recursive mimic chain: ['b', 'a', 'b']")
    with pytest.raises(MimicCycleError, match=chain):
        two(dependent_joints=dependences)


def test_a_dependence_on_an_unknown_joint_is_refused_with_those_that_exist():
    with pytest.raises(SettingsError, match=r"joint 'b' depends on joint 'x'.*it has a$"):
        two(dependent_joints={"b": Mimic("x")})


def test_a_dependence_of_an_unknown_joint_is_ignored():
    assert two(dependent_joints={"x": Mimic("y")}).names == ("b", "a")


def sweep(merged: JointStateMerge, times: int) -> list[float]:
    positions = []
    for _ in range(times):
        merged.sweep()
        positions.append(merged.state().positions[0])
    return positions


def test_the_sweep_goes_to_and_fro_between_the_limits():
    merged = merge(("j", "revolute", WIDE), delta=0.75)
    assert sweep(merged, 6) == [0.75, 1.0, 0.25, -0.5, -1.0, -0.25]


def test_the_sweep_of_a_continuous_joint_starts_again_at_the_lower_end():
    merged = merge(("j", "continuous", ""), delta=3.0)
    assert sweep(merged, 3) == [3.0, -math.pi, -math.pi + 3.0]


def test_without_delta_nothing_moves():
    assert sweep(two(), 2) == [0.0, 0.0]


def test_delta_takes_effect_at_once():
    merged = two()
    merged.set_delta(0.5)
    assert sweep(merged, 1) == [0.5]
