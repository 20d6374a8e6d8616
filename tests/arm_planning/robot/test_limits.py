import math

import pytest
from robots import joint, link, robot

from arm_description import parse_urdf
from arm_planning.errors import PlanningError
from arm_planning.robot.limits import (
    JointLimitSettings,
    joint_limit_settings,
    limits_of,
    read_joint_limits,
)
from arm_planning.robot.model import PlanningLimits

HUGE = 10**400
SAFETY = "<safety_controller soft_lower_limit='-1' soft_upper_limit='9' k_velocity='1'/>"


def part(*inside: str, kind: str = "revolute", velocity: float = 3.0):
    text = robot(link("a"), link("b"), joint("j", "a", "b", *inside, kind=kind, velocity=velocity))
    return parse_urdf(text).joints[0]


def limits(moving: object, warnings: list[str] | None = None, **given: object) -> PlanningLimits:
    found = [] if warnings is None else warnings
    settings = joint_limit_settings({"joint_limits": {"j": given}}, found.append)
    return limits_of([moving], settings, found.append)["j"]


def test_each_given_key_replaces_the_urdfs_value_even_by_a_wider_one():
    assert limits(
        part(), max_position=4.0, max_velocity=9.0, max_acceleration=2.0
    ) == PlanningLimits(-3.0, 4.0, 9.0, 2.0)


def test_dotted_names_are_those_of_a_nested_mapping():
    values = {"joint_limits.my.joint.max_jerk": 5, "joint_limits.my.joint.has_jerk_limits": True}
    settings = joint_limit_settings(values, pytest.fail)
    assert settings.joints["my.joint"].max_jerk == 5.0


def test_a_key_that_is_false_lifts_its_limit():
    found = limits(part(), has_position_limits=False, max_jerk=2.0, has_jerk_limits=False)
    assert (found.lower, found.upper, found.jerk) == (-math.inf, math.inf, math.inf)


def test_a_sliding_joint_keeps_its_range():
    warnings: list[str] = []
    found = limits(part(kind="prismatic"), warnings, has_position_limits=False, max_acceleration=1)
    assert (found.lower, found.upper) == (-3.0, 3.0)
    assert warnings == ["joint 'j' slides, so it keeps the limits of the URDF"]


def test_soft_limits_narrow_the_range():
    found = limits(part(SAFETY))
    assert (found.lower, found.upper) == (-1.0, 3.0)


def test_missing_limits_are_assumed_with_one_warning():
    warnings: list[str] = []
    assert limits(part(velocity=0.0), warnings) == PlanningLimits(-3.0, 3.0, 3.0, 6.0)
    assert warnings == [
        "joints without a velocity limit: j (3 rad/s); without an acceleration limit: "
        "j (6 rad/s^2): these values are assumed, set them in joint_limits.yaml"
    ]


def test_a_missing_acceleration_limit_alone_is_named():
    warnings: list[str] = []
    limits(part(), warnings)
    assert warnings[0].startswith("joints without an acceleration limit: j (")


def test_a_file_is_read():
    text = """
      default_velocity_scaling_factor: 0.5
      joint_limits:
        j: {has_velocity_limits: true, max_velocity: 2, max_deceleration: -4.0, max_effort: 5}
    """
    settings = read_joint_limits(text, "joint_limits.yaml", pytest.fail)
    assert settings.velocity_scaling == 0.5
    assert settings.joints["j"].max_velocity == 2.0
    assert settings.joints["j"].max_deceleration == 4.0


def test_an_empty_file_has_no_limits():
    assert read_joint_limits("", "x", pytest.fail) == JointLimitSettings()


def test_an_unknown_key_is_a_warning():
    warnings: list[str] = []
    read_joint_limits("joint_limits: {j: {max_velocty: 1.0}}", "limits.yaml", warnings.append)
    assert warnings == [
        "limits.yaml: joint_limits.j.max_velocty is passed over: did you mean 'max_velocity'?"
    ]


@pytest.mark.parametrize(
    ("text", "sentence"),
    [
        ("max_velocity: fast", "max_velocity is 'fast', which is not a finite number"),
        ("max_velocity: .nan", "max_velocity is nan, which is not a finite number"),
        (f"max_position: {HUGE}", f"max_position is {HUGE}, which is not a finite number"),
        ("max_acceleration: 0", "max_acceleration is 0; it is above 0"),
        ("has_jerk_limits: 1", "has_jerk_limits is 1; it is true or false"),
    ],
)
def test_what_is_not_a_limit_is_refused(text, sentence):
    with pytest.raises(PlanningError) as caught:
        read_joint_limits(f"joint_limits: {{j: {{{text}}}}}", "limits.yaml", pytest.fail)
    assert str(caught.value) == f"limits.yaml: joint_limits.j.{sentence}"


def test_a_scaling_factor_is_a_fraction():
    with pytest.raises(PlanningError, match="is 2; it is above 0 and at most 1"):
        joint_limit_settings({"default_velocity_scaling_factor": 2}, pytest.fail)


@pytest.mark.parametrize("text", ["a: [", "- 1"])
def test_a_file_that_is_not_a_mapping_is_refused(text):
    with pytest.raises(PlanningError, match=r"^limits\.yaml is not "):
        read_joint_limits(text, "limits.yaml", pytest.fail)


def test_a_lower_limit_above_the_upper_one_is_refused():
    with pytest.raises(PlanningError, match="has the lower limit 4 above the upper limit 3"):
        limits(part(), min_position=4.0)
