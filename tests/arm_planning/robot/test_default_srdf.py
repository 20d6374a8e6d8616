import pytest
from hypothesis import given
from hypothesis import strategies as st
from robots import joint, link, robot

from arm_description import parse_urdf
from arm_description.urdf.robot import Robot
from arm_planning.robot.build import planning_model
from arm_planning.robot.default_srdf import default_srdf
from arm_planning.robot.model import PlanningModel
from arm_planning.robot.srdf import EndEffector, Srdf, parse_srdf, srdf_text

PAD = (
    "<collision><origin xyz='0 {y} 0.02'/><geometry><sphere radius='0.01'/></geometry></collision>"
)


def serial(prefix: str, count: int, root: str) -> list[str]:
    """Links and joints of an arm: PREFIX1 is its first joint, PREFIX1_link what that moves."""
    names = [root, *(f"{prefix}{n}_link" for n in range(1, count + 1))]
    return [
        *(link(name) for name in names[1:]),
        *(joint(f"{prefix}{n}", names[n - 1], names[n]) for n in range(1, count + 1)),
    ]


def gripper(prefix: str, wrist: str) -> list[str]:
    """A palm with two fingers that slide along y; the second one follows the first."""
    left, right = f"{prefix}left", f"{prefix}right"
    mimic = f"<mimic joint='{left}' multiplier='-1'/>"
    slides = {"kind": "prismatic", "axis": "0 1 0"}
    return [
        link(f"{prefix}palm"),
        link(f"{left}_pad", PAD.format(y=0.01)),
        link(f"{right}_pad", PAD.format(y=-0.01)),
        joint(f"{prefix}mount", wrist, f"{prefix}palm", kind="fixed", limits=None),
        joint(left, f"{prefix}palm", f"{left}_pad", limits=(0.0, 0.04), **slides),
        joint(right, f"{prefix}palm", f"{right}_pad", mimic, limits=(-0.04, 0.0), **slides),
    ]


def read(*parts: str) -> tuple[Robot, Srdf, PlanningModel]:
    description = parse_urdf(robot(*parts))
    srdf = default_srdf(description)
    return description, srdf, planning_model(description, srdf, warn=lambda _: None)


def test_a_plain_arm_is_one_group_with_its_home():
    _, srdf, model = read(link("base"), *serial("j", 4, "base"))
    assert srdf.groups.keys() == {"arm"}
    arm = model.group("arm")
    assert arm.joints == ("j1", "j2", "j3", "j4")
    assert (arm.base, arm.tip) == ("base", "j4_link")
    assert model.states["arm", "home"] == dict.fromkeys(arm.joints, 0.0)


def test_an_arm_comes_before_the_wheels_below_it():
    wheels = [
        part
        for name in ("w1", "w2")
        for part in (link(name), joint(f"{name}_turn", "base", name, kind="continuous"))
    ]
    _, _, model = read(link("base"), *wheels, *serial("j", 4, "base"))
    assert list(model.groups) == ["arm", "w1", "w2"]
    assert model.default_group().name == "arm"


def test_home_is_the_limit_next_to_zero_where_zero_is_out_of_reach():
    parts = [link("base"), link("a"), joint("j", "base", "a", limits=(0.5, 2.0))]
    assert read(*parts)[2].states["arm", "home"] == {"j": 0.5}


def test_an_arm_with_a_gripper():
    _, srdf, model = read(link("base"), *serial("j", 5, "base"), *gripper("", "j5_link"))
    assert model.group("arm").tip == "palm"
    assert model.group("gripper").joints == ("left",)
    assert model.group("gripper").links == ("left_pad", "right_pad")
    assert model.group("arm_with_gripper").joints == model.joints
    assert srdf.end_effectors == {"gripper": EndEffector("palm", "gripper", "arm")}
    assert model.states["gripper", "open"] == {"left": 0.04}
    assert model.states["gripper", "closed"] == {"left": 0.0}


def test_a_frame_that_is_made_for_poses_is_the_tip():
    parts = [link("tcp"), joint("to_tcp", "palm", "tcp", kind="fixed", limits=None)]
    model = read(link("base"), *serial("j", 5, "base"), *gripper("", "j5_link"), *parts)[2]
    assert model.group("arm").tip == "tcp"


def test_two_arms_on_a_torso():
    _, srdf, model = read(
        link("base"),
        *serial("waist", 1, "base"),
        *serial("left_", 6, "waist1_link"),
        *serial("right_", 6, "waist1_link"),
        *gripper("l_", "left_6_link"),
        *gripper("r_", "right_6_link"),
    )
    assert model.group("left_arm").joints == tuple(f"left_{n}" for n in range(1, 7))
    assert model.group("waist1_link").joints == ("waist1",)
    assert srdf.end_effectors["right_gripper"] == EndEffector(
        "r_palm", "right_gripper", "right_arm"
    )


def test_a_single_jaw_is_told_by_its_name():
    jaw = [link("jaw"), joint("grip", "j5_link", "jaw", axis="0 0 1")]
    model = read(link("base"), *serial("j", 5, "base"), *jaw)[2]
    assert model.group("arm").joints == ("j1", "j2", "j3", "j4", "j5")
    assert model.group("gripper").joints == ("grip",)


def test_a_joint_that_turns_a_single_jaw_gripper_is_the_arms():
    wrist = [link("gripper_link"), joint("wrist_roll", "a3_link", "gripper_link")]
    jaw = [link("moving_jaw"), joint("gripper", "gripper_link", "moving_jaw")]
    _, srdf, model = read(link("base"), *serial("a", 3, "base"), *wrist, *jaw)
    assert model.group("arm").joints == ("a1", "a2", "a3", "wrist_roll")
    assert model.group("gripper").joints == ("gripper",)
    assert srdf.end_effectors["gripper"] == EndEffector("gripper_link", "gripper", "arm")


def test_a_sliding_last_joint_is_not_a_gripper():
    quill = [link("quill"), joint("z", "j2_link", "quill", kind="prismatic", axis="0 0 1")]
    assert read(link("base"), *serial("j", 2, "base"), *quill)[2].group("arm").joints == (
        "j1",
        "j2",
        "z",
    )


def test_a_lever_that_follows_a_joint_does_not_cut_the_arm():
    lever = [link("lever"), joint("l", "j2_link", "lever", "<mimic joint='j2' multiplier='-1'/>")]
    srdf, model = read(link("base"), *serial("j", 5, "base"), *lever)[1:]
    assert srdf.groups.keys() == {"arm"}
    assert model.group("arm").joints == ("j1", "j2", "j3", "j4", "j5")


def test_a_hand_of_many_fingers_is_a_gripper():
    fingers = [part for n in "abc" for part in serial(f"{n}", 2, "j6_link")]
    model = read(link("base"), *serial("j", 6, "base"), *fingers)[2]
    assert len(model.group("arm").joints) == len(model.group("gripper").joints) == 6


def test_legs_are_not_grippers():
    legs = [part for n in "abcd" for part in serial(f"{n}", 3, "base")]
    groups = read(link("base"), *legs)[1].groups
    assert groups.keys() == {"arm_a3_link", "arm_b3_link", "arm_c3_link", "arm_d3_link"}


def test_a_gripper_without_an_arm():
    srdf = read(link("base"), *gripper("", "base"))[1]
    assert srdf.groups.keys() == {"gripper"}
    assert srdf.end_effectors["gripper"].parent_group == ""


def test_a_robot_without_joints_has_no_groups():
    assert not read(link("base"))[1].groups


@pytest.mark.parametrize("kind", ["floating", "planar"])
def test_joints_that_are_not_planned_are_no_part_of_groups(kind):
    parts = [link("cart"), joint("drive", "world", "cart", kind=kind, limits=None)]
    model = read(link("world"), *parts, *serial("j", 3, "cart"))[2]
    assert model.group("arm").joints == ("j1", "j2", "j3")


@st.composite
def trees(draw: st.DrawFn) -> str:
    """Any tree of links, with joints of all kinds, some of which follow others."""
    count = draw(st.integers(1, 14))
    parts, scalar = [link("l0")], list[str]()
    for number in range(1, count):
        kind = draw(st.sampled_from([*["revolute"] * 3, "prismatic", "continuous", "fixed"]))
        name = draw(st.sampled_from(["j", "finger", "left_"])) + str(number)
        mimic = []
        if scalar and kind not in ("fixed", "continuous") and draw(st.booleans()):
            mimic = [f"<mimic joint='{draw(st.sampled_from(scalar))}'/>"]
        if kind != "fixed" and not mimic:
            scalar.append(name)
        parent = draw(st.integers(max(0, number - 3), number - 1))
        limits = draw(st.sampled_from([(-1.0, 2.0), (0.0, 0.0), (0.5, 1.0)]))
        bounds = limits if kind in ("revolute", "prismatic") else None
        parts.append(link(f"l{number}"))
        parts.append(joint(name, f"l{parent}", f"l{number}", *mimic, kind=kind, limits=bounds))
    return robot(*parts)


@given(trees())
def test_any_robot_has_groups_that_can_be_planned(text):
    description = parse_urdf(text)
    srdf = default_srdf(description)
    assert parse_srdf(srdf_text(srdf), description, remark=pytest.fail) == srdf
    model = planning_model(description, srdf, warn=lambda _: None)
    single = [group for name, group in model.groups.items() if not srdf.groups[name].subgroups]
    members = [name for group in single for name in group.joints]
    assert sorted(members) == sorted(model.joints)
    assert all(group.joints for group in single)
    for (name, _), state in model.states.items():
        group = model.group(name)
        positions = group.positions(state)
        assert ((group.lower <= positions) & (positions <= group.upper)).all()
    for name, group in model.groups.items():
        if srdf.groups[name].chains:
            assert group.tip == srdf.groups[name].chains[0][1]
