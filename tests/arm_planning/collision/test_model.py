from dataclasses import replace
from math import nan, pi

import numpy as np
import pytest
from planning_models import model_of, mycobot, neighbours
from robots import joint, link, robot

from arm_description import forward_kinematics
from arm_node.rigid_transform import RigidTransform
from arm_planning.collision.contact import BodyKind
from arm_planning.collision.model import CollisionModel
from arm_planning.errors import MoveItErrorCode, PlanningError
from arm_planning.scene.allowed_collisions import AllowedCollisions
from arm_planning.scene.objects import AttachedBody, CollisionObject, PlacedShape
from arm_planning.scene.scene import PlanningScene
from arm_planning.scene.shapes import Box, Cone, Cylinder, Plane, Shape, Sphere, TriangleMesh


def collision(shape: str, xyz: str = "0 0 0") -> str:
    return f"<collision><origin xyz='{xyz}'/><geometry>{shape}</geometry></collision>"


BALL = collision("<sphere radius='0.1'/>")
SLIDER = robot(
    link("base", collision("<box size='0.2 0.2 0.2'/>")),
    link("sledge", BALL),
    link("mast", BALL),
    joint("slide", "base", "sledge", kind="prismatic", axis="1 0 0", xyz="1 0 0"),
    joint("mount", "sledge", "mast", kind="fixed", xyz="0 0 0.5"),
)
"""A ball that slides along x from x = 1, with another ball fixed 0.5 m above."""


def thing(name: str, shape: Shape, *position: float) -> CollisionObject:
    x, y, z = position
    return CollisionObject(name, RigidTransform((x, y, z)), (PlacedShape(shape),))


def scene(*objects: CollisionObject, **rest) -> PlanningScene:
    return PlanningScene({}, {each.id: each for each in objects}, **rest)


def slider(*objects: CollisionObject, group: str | None = None, **rest) -> CollisionModel:
    return CollisionModel(model_of(SLIDER, arm=(("slide",), "")), scene(*objects, **rest), group)


def pairs(model: CollisionModel, *q: float) -> set[tuple[str, str]]:
    found = {(each.first, each.second) for each in model.contacts(np.array(q))}
    assert model.is_free(np.array(q)) == (not found)
    return found


def test_links_collide_with_each_other():
    assert pairs(slider(), 0.0) == set()
    assert pairs(slider(), -0.81) == {("base", "sledge")}
    assert pairs(slider(), -0.79) == set()


@pytest.mark.parametrize("roll", [0.0, 0.5, 1.0])
def test_a_capsule_through_a_board_collides(roll):
    # MuJoCo finds no contact of a capsule with a box if both of its ends are outside.
    rod = collision("<capsule radius='0.02' length='0.3'/>")
    urdf = robot(
        link("base"),
        link("rod", rod.replace("<origin", f"<origin rpy='{roll} 0 0'")),
        joint("slide", "base", "rod", kind="prismatic", axis="0 0 1"),
    )
    board = thing("board", Box((0.6, 0.6, 0.02)), 0.0, 0.0, 0.0)
    model = CollisionModel(model_of(urdf, arm=(("slide",), "")), scene(board))
    for q in (0.0, 0.02, 0.05):
        assert pairs(model, q) == {("rod", "board")}
    assert pairs(model, 0.5) == set()


def test_many_states_are_counted_up_to_the_first_that_collides():
    states = np.array([[0.0], [-0.79], [-0.81], [0.0], [-0.9]])
    assert slider().free_count(states) == 2
    assert slider().free_count(states[3:]) == 1
    assert slider().free_count(states[:2]) == 2
    with pytest.raises(PlanningError, match="not finite"):
        slider().free_count(np.array([[0.0], [nan]]))


def test_states_with_less_than_a_clearance_are_not_free():
    model, states = slider(), np.array([[0.0], [-0.795], [-0.7999]])
    assert model.free_count(states) == 3
    assert model.free_count(states, 0.004) == 2
    assert model.free_count(states, 0.006) == 1
    assert model.is_free(states[2])


def test_many_states_follow_mimic_joints():
    follower = "<mimic joint='lead' multiplier='-2' offset='0.1'/>"
    urdf = robot(
        *(link(name, BALL) for name in ("base", "first", "second")),
        joint("lead", "base", "first", kind="prismatic", axis="1 0 0", xyz="1 0 0"),
        joint("follow", "base", "second", follower, kind="prismatic", axis="0 1 0", xyz="0 1 0"),
    )
    model = CollisionModel(model_of(urdf), scene())
    states = np.array([[0.0], [0.44], [0.46]])
    assert [model.is_free(q) for q in states] == [True, True, False]
    assert model.free_count(states) == 2


def test_a_real_robots_states_are_counted_as_each_is_judged():
    model = mycobot()
    around = {f"box{n}": thing(f"box{n}", Box((0.1, 0.1, 0.1)), 0.2, 0.1 * n, 0.2) for n in (-1, 1)}
    positions = dict.fromkeys(model.joints, 0.0)
    checker = CollisionModel(model, PlanningScene(positions, around, allowed=neighbours(model)))
    limits = np.array([checker.limits(joint) for joint in checker.joints]).T
    states = np.random.default_rng(0).uniform(*limits, (300, len(checker.joints)))
    judged = [checker.is_free(q) for q in states]
    assert {True, False} == set(judged)
    assert [checker.free_count(q[None, :]) == 1 for q in states] == judged
    deep = states[judged.index(False)]
    before = checker.contacts(deep)
    checker.free_count(states)
    assert checker.contacts(deep) == before


def test_a_contact_says_what_where_and_how_deep():
    (contact,) = slider(thing("box1", Box((0.2, 0.2, 0.2)), 2.0, 0.0, 0.0)).contacts([0.803])
    assert (contact.first_kind, contact.second_kind) == (BodyKind.ROBOT_LINK, BodyKind.WORLD_OBJECT)
    assert contact.depth_m == pytest.approx(0.003, abs=1e-6)
    assert contact.position == pytest.approx((1.9015, 0, 0), abs=1e-5)
    assert contact.normal == pytest.approx((1, 0, 0), abs=1e-5)
    assert str(contact) == "sledge with box1, 3 mm deep"


@pytest.mark.parametrize(
    ("shape", "reach"),
    [
        (Box((0.2, 0.6, 0.6)), 0.1),
        (Sphere(0.15), 0.15),
        (Cylinder(0.25, 0.5), 0.25),
        (Cone(0.2, 0.4), None),
    ],
)
def test_the_shapes_of_objects(shape, reach):
    model = slider(thing("it", shape, 2.0, 0.0, 0.0))
    if reach is None:
        # The ball touches the cone's flank at a right angle: 0.1 m beyond half of its radius.
        reach = (0.1 * 0.4 + 0.1 * np.hypot(0.2, 0.4)) / 0.4 - 0.1
    assert pairs(model, 0.9 - reach - 2e-3) == set()
    assert pairs(model, 0.9 - reach + 2e-4) == {("sledge", "it")}


def test_the_point_of_a_cone_is_up():
    model = slider(thing("cone", Cone(0.1, 0.4), 2.0, 0.0, 0.0))
    assert pairs(model, 0.95) == {("sledge", "cone")}
    above = slider(thing("cone", Cone(0.1, 0.4), 2.0, 0.0, 0.25))
    assert pairs(above, 0.85) == {("sledge", "cone")}
    below = slider(thing("cone", Cone(0.1, 0.4), 2.0, 0.0, -0.25))
    assert pairs(below, 0.85) == set()


def test_a_plane_is_a_half_space():
    model = slider(thing("wall", Plane(-2.0, 0.0, 0.0, 3.0), 0.0, 0.0, 0.0))
    assert pairs(model, 0.39) == set()
    assert pairs(model, 0.41) == {("sledge", "wall"), ("mast", "wall")}
    assert pairs(model, 5.0) == {("sledge", "wall"), ("mast", "wall")}


def test_the_base_collides_with_objects_though_it_never_moves():
    box = thing("box", Box((0.2, 0.2, 0.2)), 0.15, 0.0, 0.0)
    assert pairs(slider(box), 0.0) == {("base", "box")}
    allowed = AllowedCollisions({("base", "box"): True})
    assert pairs(slider(box, allowed=allowed), 0.0) == set()


@pytest.mark.parametrize(
    ("defaults", "free"),
    [({"base": True}, True), ({"box": True}, True), ({"base": True, "box": False}, False)],
)
def test_defaults_allow_objects_to_touch(defaults, free):
    box = thing("box", Box((0.2, 0.2, 0.2)), 0.15, 0.0, 0.0)
    model = slider(box, allowed=AllowedCollisions({}, defaults))
    assert model.is_free(np.zeros(1)) == free


def test_a_contact_of_the_base_says_what_where_and_how_deep():
    (contact,) = slider(thing("ball", Sphere(0.1), 0.19, 0.0, 0.0)).contacts(np.zeros(1))
    assert str(contact) == "base with ball, 10 mm deep"
    assert contact.position == pytest.approx((0.095, 0, 0), abs=1e-6)
    assert contact.normal == pytest.approx((1, 0, 0), abs=1e-6)
    floor = slider(thing("floor", Plane(0.0, 0.0, 1.0, 0.09), 0.0, 0.0, 0.0))
    contact = {each.first: each for each in floor.contacts(np.zeros(1))}["base"]
    assert contact.depth_m == pytest.approx(0.01, abs=1e-6)
    assert contact.normal == pytest.approx((0, 0, -1), abs=1e-6)


def test_the_padding_of_the_base_counts():
    ball = thing("ball", Sphere(0.1), 0.21, 0.0, 0.0)
    assert pairs(slider(ball), 0.0) == set()
    assert pairs(slider(ball, padding={"base": 0.02}), 0.0) == {("base", "ball")}


def test_with_a_group_only_what_it_moves_is_checked():
    at_base = thing("box", Box((0.2, 0.2, 0.2)), 0.15, 0.0, 0.0)
    model = slider(at_base, group="arm")
    assert pairs(model, 0.0) == set()
    assert pairs(model, -0.81) == {("base", "sledge"), ("sledge", "box")}


def test_objects_do_not_collide_with_each_other():
    first, second = (thing(name, Sphere(0.1), 0.0, 3.0, 0.0) for name in "ab")
    assert pairs(slider(first, second), 0.0) == set()


def test_links_fixed_to_each_other_collide_unless_they_may_touch():
    overlapping = SLIDER.replace("xyz='0 0 0.5'", "xyz='0 0 0.1'")
    model = model_of(overlapping, arm=(("slide",), ""))
    assert pairs(CollisionModel(model, scene()), 0.0) == {("mast", "sledge")}
    assert pairs(CollisionModel(model, scene(), "arm"), 0.0) == {("mast", "sledge")}
    allowed = scene(allowed=AllowedCollisions({("mast", "sledge"): True}))
    assert pairs(CollisionModel(model, allowed), 0.0) == set()


def test_neighbours_across_a_joint_collide_unless_they_may_touch():
    near = model_of(SLIDER.replace("xyz='1 0 0'", "xyz='0.15 0 0'"))
    assert pairs(CollisionModel(near, scene()), 0.0) == {("base", "sledge")}
    assert pairs(CollisionModel(near, scene(allowed=neighbours(near))), 0.0) == set()


def test_padding_and_scale_are_against_the_world_only():
    wall = thing("wall", Box((0.2, 2.0, 0.2)), 2.0, 0.0, 0.0)
    padded = slider(wall, padding={"sledge": 0.05})
    assert pairs(padded, 0.76) == {("sledge", "wall")}
    assert pairs(padded, 0.74) == set()
    assert pairs(padded, -0.79) == set()
    assert pairs(padded, -0.81) == {("base", "sledge")}
    scaled = slider(wall, scale={"sledge": 0.5})
    assert pairs(scaled, 0.84) == set()
    assert pairs(scaled, 0.86) == {("sledge", "wall")}
    assert pairs(scaled, -0.81) == {("base", "sledge")}


def attached(name: str, link: str, *position: float, touch: tuple[str, ...] = ()) -> AttachedBody:
    return AttachedBody(thing(name, Sphere(0.1), *position), link, frozenset(touch))


def held(*bodies: AttachedBody, objects=(), **rest) -> CollisionModel:
    return slider(*objects, attached={body.object.id: body for body in bodies}, **rest)


def test_attached_bodies_move_with_their_link_and_may_touch_it():
    tool = attached("tool", "sledge", 0.15, 0.0, 0.0)
    wall = thing("wall", Box((0.2, 2.0, 0.2)), 2.0, 0.0, 0.0)
    model = held(tool, objects=[wall])
    assert pairs(model, 0.0) == set()
    assert pairs(model, 0.66) == {("tool", "wall")}
    (contact,) = model.contacts(np.array([0.66]))
    assert contact.first_kind is BodyKind.ROBOT_ATTACHED


def test_attached_bodies_collide_with_links_that_they_never_move_against():
    tool = attached("tool", "sledge", 0.0, 0.0, 0.35)
    assert pairs(held(tool), 0.0) == {("mast", "tool")}
    assert pairs(held(tool, group="arm"), 0.0) == {("mast", "tool")}
    touching = attached("tool", "sledge", 0.0, 0.0, 0.35, touch=("mast",))
    assert pairs(held(touching), 0.0) == set()


def test_attached_bodies_touch_others_that_are_named_or_on_the_same_link():
    on_sledge = attached("a", "sledge", 0.0, 0.3, 0.0)
    same = attached("b", "sledge", 0.0, 0.4, 0.0)
    assert pairs(held(on_sledge, same), 0.0) == set()
    other = attached("b", "mast", 0.0, 0.4, -0.5)
    assert pairs(held(on_sledge, other), 0.0) == {("a", "b")}
    named = attached("b", "mast", 0.0, 0.4, -0.5, touch=("a",))
    assert pairs(held(on_sledge, named), 0.0) == set()


def test_a_body_attached_to_the_base_collides_with_what_moves_and_with_the_world():
    body = attached("lamp", "base", 0.5, 0.0, 0.0)
    box = thing("box", Box((0.2, 0.2, 0.2)), 0.5, 0.15, 0.0)
    assert pairs(held(body), -0.31) == {("sledge", "lamp")}
    assert pairs(held(body, objects=[box]), 0.0) == {("lamp", "box")}


def test_mimic_joints_follow_and_joints_outside_of_the_group_stay():
    urdf = robot(
        *(link(name, BALL) for name in ("base", "one", "two", "three")),
        joint("lead", "base", "one", kind="prismatic", axis="1 0 0", xyz="1 0 0"),
        joint(
            "follow",
            "base",
            "two",
            "<mimic joint='lead' multiplier='2' offset='0.1'/>",
            kind="prismatic",
            axis="1 0 0",
            xyz="1 1 0",
        ),
        joint("apart", "base", "three", kind="prismatic", axis="0 1 0", xyz="1 2 0"),
    )
    model = model_of(urdf, arm=(("lead",), ""))
    state = PlanningScene({"lead": 0.0, "apart": -0.5})
    found = CollisionModel(model, state, "arm")
    expected = forward_kinematics(model.robot, {"lead": 0.3, "apart": -0.5})
    for name, pose in expected.items():
        assert found.link_pose(np.array([0.3]), name) == pytest.approx(pose, abs=1e-12)
    # At lead = -0.05 the follower is at x = 1, 0.15 from what stays at y = 1.5.
    elsewhere = PlanningScene({"lead": 0.0, "apart": -0.85})
    moved = CollisionModel(model, elsewhere, "arm", like=found)
    assert pairs(found, -0.05) == set()
    assert pairs(moved, -0.05) == {("three", "two")}


def test_all_of_a_real_robots_links_are_where_forward_kinematics_puts_them():
    model = mycobot()
    rest = dict.fromkeys(model.joints, 0.0) | {"gripper_controller": -0.3}
    q = np.array([0.3, -0.5, 0.8, -0.2, 0.4, 1.0])
    arm = CollisionModel(model, PlanningScene(rest), "arm")
    positions = rest | dict(zip(arm.joints, q.tolist(), strict=True))
    whole = CollisionModel(model, PlanningScene(rest))
    every = np.array([positions[name] for name in whole.joints])
    for name, pose in forward_kinematics(model.robot, positions).items():
        assert arm.link_pose(q, name) == pytest.approx(pose, abs=1e-9), name
        assert whole.link_pose(every, name) == pytest.approx(pose, abs=1e-9), name


def test_a_turn_of_a_continuous_joint_comes_back():
    urdf = robot(
        link("base"),
        link("arm", collision("<box size='0.1 0.1 0.1'/>", "1 0 0")),
        joint("spin", "base", "arm", kind="continuous", axis="0 0 1", limits=None),
    )
    model = CollisionModel(model_of(urdf), scene(thing("post", Sphere(0.1), 0.0, 1.0, 0.0)))
    assert pairs(model, 0.0) == set()
    assert pairs(model, pi / 2) == {("arm", "post")}
    assert pairs(model, pi / 2 - 4 * pi) == {("arm", "post")}


@pytest.mark.parametrize("bad", [nan, np.inf, -np.inf])
def test_states_that_are_not_finite_are_refused(bad):
    with pytest.raises(PlanningError, match="positions that are not finite"):
        slider().is_free(np.array([bad]))


def test_unknown_links_are_named():
    with pytest.raises(PlanningError, match="no link 'slegde'; did you mean 'sledge'"):
        slider().link_pose(np.array([0.0]), "slegde")
    with pytest.raises(PlanningError, match="object 'a' is attached to 'hand': no such link"):
        held(attached("a", "hand", 0.0, 0.0, 0.0))


@pytest.mark.parametrize(
    ("shape", "message"),
    [
        (Box((0.1, 0.0, 0.1)), "object 'it': a box of 0.1 x 0 x 0.1 m is not a shape with a size"),
        (Sphere(-1.0), "object 'it': a sphere of -1 m is not a shape with a size"),
        (Cylinder(nan, 1.0), "object 'it': a cylinder of nan x 1 m is not a shape with a size"),
        (Cone(0.1, 0.0), "object 'it': a cone of 0.1 x 0 m is not a shape with a size"),
        (Plane(0.0, 0.0, 0.0, 1.0), "object 'it': a plane has no valid normal: 0, 0, 0"),
    ],
)
def test_shapes_without_a_size_are_refused(shape, message):
    with pytest.raises(PlanningError, match=message) as caught:
        slider(thing("it", shape, 0.0, 0.0, 5.0))
    assert caught.value.code is MoveItErrorCode.INVALID_OBJECT_NAME


def test_poses_that_are_none_are_refused():
    box = thing("it", Sphere(0.1), 0.0, 0.0, 5.0)
    nowhere = replace(box, pose=RigidTransform((nan, 0.0, 0.0)))
    with pytest.raises(PlanningError, match="object 'it': it has no valid pose"):
        slider(nowhere)
    turned = replace(box, pose=RigidTransform(rotation=(0.0, 0.0, 0.0, 0.0)))
    with pytest.raises(PlanningError, match="object 'it': it has no valid pose"):
        slider(turned)


def test_a_plane_cannot_be_attached():
    body = AttachedBody(thing("floor", Plane(0.0, 0.0, 1.0, 0.0), 0.0, 0.0, 0.0), "sledge")
    with pytest.raises(PlanningError, match="'floor' has a plane, which cannot be attached"):
        held(body)


def changed(before: PlanningScene, rng: np.random.Generator) -> PlanningScene:
    """A scene after one change of a kind that users make."""
    objects, names = dict(before.objects), sorted(before.objects)
    name = str(rng.choice(names)) if names else ""
    x, y, z = rng.uniform((0.6, -0.4, -0.2), (1.6, 0.4, 0.8))
    shapes = (Box((0.2, 0.3, 0.1)), Sphere(0.1), Cylinder(0.1, 0.2), tetrahedron(0.2))
    match rng.integers(5) if names else 0:
        case 0:
            new = f"thing{rng.integers(9)}"
            objects[new] = thing(new, shapes[rng.integers(4)], x, y, z)
        case 1:
            moved = RigidTransform((x, y, z), (0.0, 0.0, 0.6, 0.8))
            objects[name] = replace(objects[name], pose=moved)
        case 2:
            del objects[name]
        case 3:
            allowed = AllowedCollisions({("mast", name): bool(rng.integers(2))})
            return replace(before, allowed=allowed)
        case _:
            held = CollisionObject("held", RigidTransform(), (PlacedShape(Box((0.1, 0.1, 0.3))),))
            body = AttachedBody(held, "mast", frozenset({"mast"}))
            return replace(before, attached={} if before.attached else {"held": body})
    return replace(before, objects=objects)


def tetrahedron(size: float) -> TriangleMesh:
    corners = size * np.array([[0.0, 0, 0], [1, 0, 0], [0, 1, 0], [0, 0, 1]])
    return TriangleMesh(corners, np.array([[0, 2, 1], [0, 1, 3], [0, 3, 2], [1, 2, 3]]))


@pytest.mark.parametrize("seed", range(4))
def test_after_changes_a_model_says_what_a_new_one_says(seed):
    rng = np.random.default_rng(seed)
    model, now = slider(), scene()
    for _ in range(40):
        now = changed(now, rng)
        model = CollisionModel(model_of(SLIDER, arm=(("slide",), "")), now, like=model)
        fresh = CollisionModel(model_of(SLIDER, arm=(("slide",), "")), now)
        assert len(model.constant_contacts) == len(fresh.constant_contacts)
        for q in rng.uniform(-0.9, 0.5, (8, 1)):
            found, expected = model.contacts(q), fresh.contacts(q)
            assert [str(each) for each in found] == [str(each) for each in expected]


def test_a_moved_removed_or_returned_object_needs_no_compilation():
    box = thing("box", Box((0.2, 0.2, 0.2)), 2.0, 0.0, 0.0)
    first = slider(box, thing("other", Sphere(0.1), 0.0, 2.0, 0.0))
    robot_model = model_of(SLIDER, arm=(("slide",), ""))

    def after(*objects: CollisionObject) -> CollisionModel:
        model = CollisionModel(robot_model, scene(*objects), like=first)
        assert model.compiled.spec is first.compiled.spec
        return model

    near = replace(box, pose=RigidTransform((1.0, 0.15, 0.0)))
    assert pairs(after(near), 0.0) == {("sledge", "box")}
    assert pairs(after(), 0.85) == set()
    assert pairs(after(box), 0.85) == {("sledge", "box")}
    assert pairs(first, 0.85) == {("sledge", "box")}


def test_a_mesh_that_is_sent_again_is_the_same_mesh():
    first = slider(thing("wedge", tetrahedron(0.2), 1.0, 0.0, 0.0))
    again = scene(thing("wedge", tetrahedron(0.2), 1.0, 0.0, 0.5))
    model = CollisionModel(model_of(SLIDER, arm=(("slide",), "")), again, like=first)
    assert model.compiled.spec is first.compiled.spec
    other = scene(thing("wedge", tetrahedron(0.3), 1.0, 0.0, 0.5))
    model = CollisionModel(model_of(SLIDER, arm=(("slide",), "")), other, like=first)
    assert model.compiled.spec is not first.compiled.spec


def test_a_scene_does_not_grow_with_objects_that_come_and_go():
    model = slider()
    for number in range(100):
        ball = thing(f"ball{number}", Sphere(0.1), 1.0, 0.0, 0.0)
        model = CollisionModel(model_of(SLIDER, arm=(("slide",), "")), scene(ball), like=model)
    assert len(model.compiled.bodies) < 40
    assert pairs(model, 0.0) == {("sledge", "ball99")}
