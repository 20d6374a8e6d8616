from functools import cache
from itertools import combinations

import numpy as np
import pytest
from robots import joint, link, robot

from arm_description import expand_xacro, parse_urdf, resolve_uri
from arm_planning.collision.model import CollisionModel
from arm_planning.robot.build import planning_model
from arm_planning.robot.srdf import Srdf, parse_srdf
from arm_planning.scene.allowed_collisions import AllowedCollisions, allowed_collisions
from arm_planning.scene.scene import PlanningScene
from arm_planning.srdf_maker import free_start, make_srdf

CONFIG = "package://mycobot_moveit_config/config/mycobot_280"
MYCOBOT = "package://mycobot_description/urdf/robots/mycobot_280.urdf.xacro"


def ball(name: str, radius: float, x: float = 0.0) -> str:
    """A link that is a ball beside its joint."""
    return link(
        name,
        f"<collision><origin xyz='{x} 0 0'/><geometry><sphere radius='{radius}'/></geometry>"
        "</collision>",
    )


# All joints turn about one axis, on which the base is; x says how far from it a ball is.
SPINNER = robot(
    ball("base", 0.1),
    link("frame"),
    ball("arm", 0.1, x=0.5),
    ball("inside", 0.06, x=0.05),
    ball("ring", 0.05, x=0.5),
    ball("outer", 0.05, x=0.653),
    joint("mount", "base", "frame", kind="fixed", limits=None),
    joint("arm_turn", "frame", "arm", axis="0 0 1"),
    joint("inside_turn", "arm", "inside", axis="0 0 1"),
    joint("ring_turn", "inside", "ring", axis="0 0 1"),
    joint("outer_turn", "ring", "outer", axis="0 0 1"),
)


@cache
def made() -> tuple[Srdf, tuple[str, ...]]:
    sentences: list[str] = []
    return make_srdf(parse_urdf(SPINNER), sentences.append), tuple(sentences)


def test_pairs_that_need_no_check_are_told_by_samples():
    # The ring meets the arm, and the outer ball comes within 3 mm of it.
    assert made()[0].disabled == {
        ("arm", "base"): "Adjacent",
        ("arm", "inside"): "Adjacent",
        ("inside", "ring"): "Adjacent",
        ("outer", "ring"): "Adjacent",
        ("base", "inside"): "Always",
        ("base", "outer"): "Never",
        ("base", "ring"): "Never",
        ("inside", "outer"): "Never",
    }


def test_home_is_moved_away_from_what_collides_there():
    srdf, told = made()
    assert told == (
        "at home arm with ring, 150 mm deep: home is moved to a state without contact; if the two "
        "may touch, disable their collisions",
    )
    model = planning_model(parse_urdf(SPINNER), srdf, warn=lambda _: None)
    scene = PlanningScene(dict.fromkeys(model.joints, 0.0), allowed=allowed_collisions(srdf))
    home = model.states["arm", "home"]
    q = np.array([home[joint] for joint in model.joints])
    assert CollisionModel(model, scene).free_count(q[None], clearance_m=0.005) == 1
    assert 0.0 < max(map(abs, q)) < 1.0
    assert 0.0 in q, "joints that need not move stay"


def test_a_robot_that_touches_itself_at_zero_starts_at_the_home_of_its_srdf():
    start = free_start(parse_urdf(SPINNER))
    assert {joint: (q,) for joint, q in start.items()} == made()[0].states["arm", "home"]


def test_a_robot_that_is_in_the_floor_at_zero_starts_above_it():
    low = robot(
        ball("base", 0.1),
        ball("arm", 0.1, x=0.5),
        joint("bend", "base", "arm", xyz="0 0 0.08", axis="0 1 0", limits=(-1.0, 1.0)),
    )
    (angle,) = free_start(parse_urdf(low)).values()
    # The ball of 0.1 m is 0.08 m high, 0.5 m from the joint: 5 mm are between it and the floor.
    assert 0.08 + 0.5 * np.sin(-angle) >= 0.105
    told: list[str] = []
    assert make_srdf(parse_urdf(low), told.append).states["arm", "home"] == {"bend": (angle,)}
    assert told == [
        "at home arm with <floor>, 20 mm deep: home is moved to a state without contact"
    ]


def test_a_robot_that_is_in_the_floor_everywhere_stays_there():
    sunk = robot(
        ball("base", 0.1), ball("arm", 0.1, x=0.5), joint("turn", "base", "arm", axis="0 0 1")
    )
    assert free_start(parse_urdf(sunk)) == {}


def test_a_robot_that_is_free_at_zero_starts_there():
    turn = joint("turn", "base", "arm", xyz="0 0 0.2")
    apart = robot(ball("base", 0.1), ball("arm", 0.1, x=0.5), turn)
    assert free_start(parse_urdf(apart)) == {}


def test_a_robot_that_collides_everywhere_keeps_its_home():
    fixed = {"kind": "fixed", "limits": None}
    between_walls = robot(
        link("base"),
        *(ball("left", 0.65), ball("right", 0.65), ball("arm", 0.1, x=0.5)),
        joint("left_mount", "base", "left", xyz="0 0.5 0", **fixed),
        joint("right_mount", "base", "right", xyz="0 -0.5 0", **fixed),
        joint("turn", "base", "arm", axis="0 0 1"),
    )
    told: list[str] = []
    srdf = make_srdf(parse_urdf(between_walls), told.append)
    assert srdf.states["arm", "home"] == {"turn": (0.0,)}
    assert [sentence.split(", ")[0] for sentence in told] == [
        "at home arm with left",
        "at home arm with right",
    ]
    assert all(": set another state; if the two may touch" in sentence for sentence in told)


def test_the_links_of_a_gripper_may_touch_where_it_is_closed():
    def slides(name: str, axis: str, **more: str) -> str:
        return joint(name, "hand", name, kind="prismatic", axis=axis, limits=(0.0, 0.1), **more)

    gripper = robot(
        ball("base", 0.05),
        *(ball("arm", 0.05, x=0.5), ball("hand", 0.02), ball("rail", 0.01, x=0.1)),
        *(ball("left_finger", 0.02, x=0.2), ball("right_finger", 0.02, x=0.2)),
        joint("turn", "base", "arm", axis="0 0 1", xyz="0 0 0.1"),
        joint("bend", "arm", "hand", axis="0 1 0", xyz="1 0 0"),
        joint("mount", "hand", "rail", kind="fixed", limits=None),
        slides("left_finger", "0 1 0", xyz="0 0.02 0"),
        slides("right_finger", "0 -1 0", xyz="0 -0.02 0"),
    )
    told: list[str] = []
    srdf = make_srdf(parse_urdf(gripper), told.append)
    assert srdf.disabled["left_finger", "right_finger"] == "Default"
    assert not told


def with_arms(count: int) -> str:
    """A pole with arms above each other; each touches a post of its own in most of its range."""
    parts = [link("pole")]
    for n in range(count):
        arm, post = f"arm{n}", f"post{n}"
        parts += [ball(arm, 0.1, x=0.5), ball(post, 0.1, x=0.5)]
        parts.append(
            joint(f"mount{n}", "pole", post, kind="fixed", xyz=f"0 0 {n + 1}", limits=None)
        )
        limits = (-0.5, 0.6)
        parts.append(joint(arm, "pole", arm, axis="0 0 1", xyz=f"0 0 {n + 1}", limits=limits))
    return robot(*parts)


def test_a_robot_of_many_joints_starts_where_nothing_touches():
    """A random state of all joints is free once in ten million times."""
    start = free_start(parse_urdf(with_arms(12)))
    # Balls of 0.1 m touch up to 0.4027 rad; 5 mm apart they are from 0.413 rad on.
    assert len(start) == 12
    assert all(0.4 < abs(angle) <= 0.6 for angle in start.values())


def test_a_home_that_stays_in_the_floor_is_not_called_free():
    seesaw = robot(
        *(ball("hips", 0.1), ball("left", 0.1, x=0.5), ball("right", 0.1, x=0.5)),
        *(ball("post", 0.1), ball("arm", 0.1, x=0.5)),
        joint("step", "hips", "left", limits=(-1.0, 1.0)),
        joint(
            *("back", "hips", "right", "<mimic joint='step' multiplier='-1'/>"),
            xyz="0 0.5 0",
            limits=(-1.0, 1.0),
        ),
        joint("mount", "hips", "post", kind="fixed", xyz="0.5 0 0.8", limits=None),
        joint("turn", "hips", "arm", axis="0 0 1", xyz="0 0 0.8", limits=(-1.0, 1.0)),
    )
    told: list[str] = []
    make_srdf(parse_urdf(seesaw), told.append)
    assert told[0].startswith(
        "at home arm with post, 200 mm deep: home is moved to a state without"
    )
    assert sorted(told[1:]) == [
        "at home left with <floor>, 100 mm deep: set another state",
        "at home right with <floor>, 100 mm deep: set another state",
    ]


def telescope(second_axis: str) -> str:
    """A lift of two sections that are drawn in at zero, the second turned back, with an arm."""
    slides = {"kind": "prismatic", "limits": (0.0, 2.0)}
    first = joint("lift", "base", "outer", axis="0 0 1", xyz="0 0 0.15", **slides)
    second = joint("lift_more", "outer", "inner", axis=second_axis, **slides)
    return robot(
        *(ball("base", 0.1), ball("outer", 0.1), ball("inner", 0.1), ball("plate", 0.1)),
        ball("arm", 0.02, x=0.5),
        first,
        second.replace("xyz='0 0 0'", "rpy='0 -1 0'"),
        joint("mount", "inner", "plate", kind="fixed", xyz="0.05 0 0", limits=None),
        joint("turn", "plate", "arm", axis="0 0 1", limits=(-1.0, 1.0)),
    )


ALONG = f"{np.sin(1.0)} 0 {np.cos(1.0)}"
"""The axis of the first section in the frame of the second, which is turned back."""


def test_the_sections_of_a_telescope_may_touch_where_it_is_drawn_in():
    told: list[str] = []
    srdf = make_srdf(parse_urdf(telescope(ALONG)), told.append)
    inside = [("base", "inner"), ("base", "plate"), ("outer", "plate")]
    assert [srdf.disabled[pair] for pair in inside] == ["Default"] * 3
    assert not told
    assert free_start(parse_urdf(telescope(ALONG))) == {}


def test_slides_across_each_other_are_no_telescope():
    srdf = make_srdf(parse_urdf(telescope("0 1 0")), lambda _sentence: None)
    assert ("base", "inner") not in srdf.disabled
    assert srdf.disabled["outer", "plate"] == "Default"


def beside_a_post(kind: str, limits: tuple[float, float] | None) -> str:
    """A wheel, out of round, that touches a post at zero; both are on one frame."""
    return robot(
        *(ball("frame", 0.05), ball("post", 0.1), ball("wheel", 0.1, x=0.02)),
        joint("mount", "frame", "post", kind="fixed", xyz="0 0.5 0.5", limits=None),
        joint("drive", "frame", "wheel", kind=kind, xyz="-0.205 0.5 0.5", limits=limits),
    )


def test_a_wheel_may_touch_what_stands_beside_it():
    srdf = make_srdf(parse_urdf(beside_a_post("continuous", None)), pytest.fail)
    assert srdf.disabled["post", "wheel"] == "Default"


def test_a_link_that_turns_between_limits_may_not_touch_what_stands_beside_it():
    told: list[str] = []
    srdf = make_srdf(parse_urdf(beside_a_post("revolute", (-3.0, 3.0))), told.append)
    assert ("post", "wheel") not in srdf.disabled
    assert told[0].startswith("at home post with wheel, ")


def test_two_carriages_on_one_rail_are_checked():
    rail = robot(
        ball("rail", 0.05),
        *(ball("left", 0.1), ball("right", 0.1)),
        joint("left_slide", "rail", "left", kind="prismatic", axis="1 0 0", limits=(0, 1)),
        joint("right_slide", "rail", "right", kind="prismatic", axis="1 0 0", limits=(0, 1)),
    )
    assert ("left", "right") not in make_srdf(parse_urdf(rail), lambda _: None).disabled


def test_the_same_robot_gives_the_same_srdf():
    assert make_srdf(parse_urdf(SPINNER), lambda _: None) == made()[0]


def test_too_few_samples_are_refused():
    with pytest.raises(ValueError, match="5 samples are too few; there must be at least 10000"):
        make_srdf(parse_urdf(SPINNER), pytest.fail, samples=5)


def test_no_pair_that_the_mycobots_srdf_leaves_out_touches_in_a_state():
    description = parse_urdf(expand_xacro(resolve_uri(MYCOBOT), {}))
    text = resolve_uri(f"{CONFIG}/mycobot_280.srdf").read_text()
    srdf = parse_srdf(text, description)
    model = planning_model(description, srdf, warn=lambda _: None)
    never = {pair for pair, reason in srdf.disabled.items() if reason == "Never"}
    every = [(a.name, b.name) for a, b in combinations(description.links, 2)]
    others = {(min(pair), max(pair)): True for pair in every} | dict.fromkeys(never, False)
    scene = PlanningScene(dict.fromkeys(model.joints, 0.0), allowed=AllowedCollisions(others))
    collisions = CollisionModel(model, scene)
    limits = [description.joint(name).limit for name in model.joints]
    lower, upper = ([getattr(limit, side) for limit in limits] for side in ("lower", "upper"))
    states = np.random.default_rng(0).uniform(lower, upper, (5000, len(limits)))
    assert len(never) == 33
    assert all(collisions.is_free(q) for q in states)
