from collections.abc import Iterable
from itertools import pairwise

import numpy as np
import pytest
from collision_judge import Judge
from planning_models import model_of, neighbours
from robots import joint, link, robot

from arm_node.rigid_transform import RigidTransform
from arm_planning.collision import specification
from arm_planning.collision.approach import Approach, Near
from arm_planning.collision.contact import BodyKind
from arm_planning.collision.model import CollisionModel
from arm_planning.collision.motion_proof import MotionProof, Obstruction
from arm_planning.robot.model import JointGroup, PlanningModel
from arm_planning.scene.objects import AttachedBody, CollisionObject, PlacedShape
from arm_planning.scene.scene import PlanningScene
from arm_planning.scene.shapes import Box, Cone, Cylinder, Plane, Shape, Sphere, TriangleMesh

LINKS = (
    "<cylinder radius='0.04' length='0.2'/>",
    "<box size='0.05 0.07 0.25'/>",
    "<capsule radius='0.03' length='0.15'/>",
    "<box size='0.04 0.12 0.06'/>",
    "<sphere radius='0.04'/>",
)
AXES = ("0 0 1", "0 1 0", "1 0 0", "0 0.6 0.8", "0.6 0 0.8")


def collision(shape: str, xyz: str = "0 0 0") -> str:
    return f"<collision><origin xyz='{xyz}'/><geometry>{shape}</geometry></collision>"


def arm(rng: np.random.Generator) -> PlanningModel:
    """An arm of four joints of which one slides, and a gripper whose second finger follows."""
    links = [link("l0", collision("<box size='0.1 0.1 0.1'/>"))]
    joints = []
    slides = int(rng.integers(1, 4))
    for number in range(1, 5):
        shape, axis = rng.choice(LINKS), rng.choice(AXES)
        links.append(link(f"l{number}", collision(shape, f"0 0 {rng.uniform(0.05, 0.15):.3f}")))
        kind = "prismatic" if number == slides else "revolute"
        span = (-0.1, 0.1) if number == slides else (-2.5, 2.5)
        place = f"{rng.uniform(-0.05, 0.05):.3f} 0 {rng.uniform(0.15, 0.25):.3f}"
        names = (f"j{number}", f"l{number - 1}", f"l{number}")
        joints.append(joint(*names, kind=kind, axis=axis, limits=span, xyz=place))
    for side in ("left", "right"):
        links.append(link(side, collision("<box size='0.02 0.03 0.08'/>", "0 0 0.04")))
    joints.append(joint("left", "l4", "left", axis="1 0 0", limits=(-1.0, 1.0), xyz="0 0.04 0.15"))
    mimic = "<mimic joint='left' multiplier='-1.5' offset='0.1'/>"
    joints.append(joint("right", "l4", "right", mimic, axis="1 0 0", xyz="0 -0.04 0.15"))
    return model_of(
        robot(*links, *joints), arm=(("j1", "j2", "j3", "j4"), "l4"), every=(ALL_JOINTS, "l4")
    )


ALL_JOINTS = ("j1", "j2", "j3", "j4", "left")
WEDGE = TriangleMesh(
    np.array([[0.0, 0, 0], [0.15, 0, 0], [0, 0.15, 0], [0, 0, 0.15], [0.05, 0.05, 0.03]]),
    np.array([[0, 2, 1], [0, 1, 3], [0, 3, 2], [1, 2, 4], [2, 3, 4], [3, 1, 4]]),
)
"""A corner with a dent."""


def surroundings(rng: np.random.Generator) -> dict[str, CollisionObject]:
    shapes: list[Shape] = [
        Box((0.15, 0.2, 0.1)),
        Box((0.3, 0.02, 0.2)),
        Sphere(0.07),
        Cylinder(0.05, 0.2),
        Cone(0.08, 0.2),
        WEDGE,
    ]
    things = {"floor": CollisionObject("floor", RigidTransform(), (floor(),))}
    for number, shape in enumerate(shapes):
        turn = rng.normal(size=4)
        turn /= np.linalg.norm(turn)
        x, y = rng.normal(size=2) * 0.3
        pose = RigidTransform((x, y, rng.uniform(0.1, 0.8)), tuple(turn.tolist()))
        things[f"o{number}"] = CollisionObject(f"o{number}", pose, (PlacedShape(shape),))
    return things


def floor() -> PlacedShape:
    return PlacedShape(Plane(0.1, 0.0, 2.0, 0.3))


def random_scene(seed: int) -> tuple[PlanningModel, PlanningScene, np.random.Generator]:
    rng = np.random.default_rng(seed)
    model = arm(rng)
    held = CollisionObject("held", RigidTransform((0.0, 0.0, 0.2)), (PlacedShape(Sphere(0.05)),))
    scene = PlanningScene(
        dict.fromkeys(ALL_JOINTS, 0.0),
        surroundings(rng),
        {"held": AttachedBody(held, "l4", frozenset({"left", "right"}))},
        neighbours(model),
    )
    return model, scene, rng


def free_state(model: CollisionModel, limits: JointGroup, rng: np.random.Generator) -> np.ndarray:
    states = (rng.uniform(limits.lower, limits.upper) for _ in range(1000))
    return next(q for q in states if model.is_free(q))


def dense(path: np.ndarray, step: float) -> np.ndarray:
    parts = [
        np.linspace(a, b, max(2, int(np.ceil(np.abs(b - a).max() / step)) + 1))
        for a, b in pairwise(path)
    ]
    return np.concatenate(parts)


@pytest.mark.parametrize("named_pairs", [0, specification.MAX_NAMED_PAIRS])
@pytest.mark.parametrize("seed", [0, 3])
def test_what_is_proved_is_free_in_the_eyes_of_another_library(seed, named_pairs, monkeypatch):
    monkeypatch.setattr(specification, "MAX_NAMED_PAIRS", named_pairs)
    model, scene, rng = random_scene(seed)
    group = model.group("every" if seed % 2 else "arm")
    checker = CollisionModel(model, scene, group.name)
    proof, judge = MotionProof(checker), Judge(model, scene)
    proved = 0
    while proved < 3:
        a = free_state(checker, group, rng)
        b = a + rng.normal(size=len(a)) * (0.05, 0.3)[proved % 2]
        if proof.prove(np.stack([a, b])) is not None:
            continue
        proved += 1
        for q in dense(np.stack([a, b]), 0.001):
            state = scene.positions | dict(zip(group.joints, q.tolist(), strict=True))
            assert judge.is_free(state), (a, b, q)


def test_states_collide_if_another_library_says_so():
    model, scene, rng = random_scene(7)
    group = model.group("every")
    checker = CollisionModel(model, scene, "every")
    proof, judge = MotionProof(checker), Judge(model, scene)
    free = 0
    for _ in range(300):
        q = rng.uniform(group.lower, group.upper)
        contacts = checker.contacts(q)
        clear = not contacts and proof.prove(q[None]) is None
        # Nearer than a tenth of a millimetre the two may differ.
        if clear or (contacts and contacts[0].depth_m > 1e-4):
            state = scene.positions | dict(zip(group.joints, q.tolist(), strict=True))
            assert judge.is_free(state) == clear, contacts
        free += clear
    assert 30 < free < 270


@pytest.mark.parametrize("seed", [0, 3, 5])
def test_curves_near_a_proved_chord_are_free(seed):
    model, scene, rng = random_scene(seed)
    group = model.group("every")
    checker = CollisionModel(model, scene, "every")
    proof, judge = MotionProof(checker), Judge(model, scene)
    proved = 0
    while proved < 4:
        a = free_state(checker, group, rng)
        b = a + rng.normal(size=len(a)) * 0.1
        deviation = rng.uniform(0.0, 0.05, (1, len(a)))
        if proof.prove(np.stack([a, b]), deviation) is not None:
            continue
        proved += 1
        at = np.linspace(0.0, 1.0, 60)[:, None]
        phase, turns = rng.uniform(0.0, 6.28, len(a)), rng.integers(0, 8, len(a))
        for q in a + at * (b - a) + deviation * np.sin(phase + 6.28 * turns * at):
            state = scene.positions | dict(zip(group.joints, q.tolist(), strict=True))
            assert judge.is_free(state)


SLIDER = robot(
    link("base"),
    link("ball", collision("<sphere radius='0.1'/>")),
    joint("x", "base", "ball", kind="prismatic", axis="1 0 0", limits=(-5.0, 5.0)),
)


def slider(*walls: float) -> MotionProof:
    """A ball of 0.1 m on a slider, and thin walls across its way."""
    wall = PlacedShape(Box((0.002, 1.0, 1.0)))
    things = [CollisionObject(f"wall{x:g}", RigidTransform((x, 0.0, 0.0)), (wall,)) for x in walls]
    scene = PlanningScene({}, {thing.id: thing for thing in things})
    return MotionProof(CollisionModel(model_of(SLIDER), scene))


def line(*places: float) -> np.ndarray:
    return np.array(places)[:, None]


def test_a_thin_wall_is_never_stepped_over():
    proof = slider(1.0)
    assert proof.prove(line(-4.0, 0.8)) is None
    obstruction = proof.prove(line(-4.0, 4.0))
    assert obstruction is not None
    assert obstruction.contact is not None
    assert obstruction.contact.second == "wall1"
    assert abs(obstruction.fraction * 8.0 - 5.0) <= 0.1012
    assert not proof.is_free_edge(np.array([-4.0]), np.array([4.0]))
    assert proof.is_free_edge(np.array([-4.0]), np.array([0.8]))


def test_an_obstruction_names_segment_fraction_and_contact():
    obstruction = slider(1.0).prove(line(-1.0, 0.5, 0.95))
    assert isinstance(obstruction, Obstruction)
    assert obstruction.segment == 1
    assert 0.5 + 0.45 * obstruction.fraction == pytest.approx(0.9, abs=0.05)
    assert obstruction.contact is not None
    assert obstruction.contact.first == "ball"
    assert obstruction.contact.second_kind is BodyKind.WORLD_OBJECT
    assert obstruction.reason.startswith("ball with wall1, ")
    assert str(obstruction) == obstruction.reason


def between_walls() -> MotionProof:
    return MotionProof(box_and_walls())


def box_and_walls() -> CollisionModel:
    """A box of 0.1 m that slides along x and y between long walls at y = -1 and y = 1."""
    urdf = robot(
        *(link(name) for name in ("base", "across")),
        link("box", collision("<box size='0.1 0.1 0.1'/>")),
        joint("x", "base", "across", kind="prismatic", axis="1 0 0", limits=(-9.0, 9.0)),
        joint("y", "across", "box", kind="prismatic", axis="0 1 0", limits=(-9.0, 9.0)),
    )
    shape = PlacedShape(Box((20.0, 0.1, 0.1)))
    walls = {
        name: CollisionObject(name, RigidTransform((0.0, y, 0.0)), (shape,))
        for name, y in (("right", -1.0), ("left", 1.0))
    }
    return CollisionModel(model_of(urdf), PlanningScene({}, walls))


def along(clearance: float, side: float = 1.0) -> np.ndarray:
    """A path that goes to a wall, half a metre along it and away."""
    y = side * (0.9 - clearance)
    return np.array([[0.0, 0.0], [0.0, y], [0.5, y], [0.5, 0.0]])


def test_what_stays_closer_than_a_tenth_of_a_millimetre_is_not_proved():
    assert between_walls().prove(along(1.1e-4)) is None
    obstruction = between_walls().prove(along(0.9e-4))
    assert obstruction is not None
    assert obstruction.contact is not None
    assert obstruction.contact.depth_m == pytest.approx(-0.9e-4, abs=2e-5)
    assert obstruction.reason.endswith("closer than the 0.1 mm that the proof of a motion needs")


def test_what_a_curve_may_take_of_the_clearance_is_said():
    deviation = np.zeros((3, 2))
    deviation[1, 1] = 4e-4
    obstruction = between_walls().prove(along(4.5e-4), deviation)
    assert obstruction is not None
    assert obstruction.reason.endswith(
        "0.45 mm apart, closer than the 0.5 mm that the proof of a motion needs"
    )


def test_an_end_that_is_free_but_very_close_can_be_left_and_reached():
    leaving = along(5e-5)[1:]
    assert between_walls().prove(leaving) is None
    assert between_walls().prove(leaving[::-1]) is None
    # Only what is that close at the end may be so on the way.
    obstruction = between_walls().prove(np.concatenate([leaving, along(5e-5, -1.0)]))
    assert obstruction is not None
    assert str(obstruction).startswith("box with right")


def test_speeds_are_those_of_the_state_after_its_floors_were_relaxed(monkeypatch):
    model, path, seen = box_and_walls(), along(5e-5)[1:], []
    clear = Approach.clear

    def spy(approach: Approach, near: Iterable[Near], limit: float) -> float:
        seen.append(model.posed.data.qpos.copy())
        return clear(approach, near, limit)

    monkeypatch.setattr(Approach, "clear", spy)
    assert MotionProof(model).prove(path) is None
    assert seen
    assert not any(np.array_equal(q, path[-1]) for q in seen)


@pytest.mark.parametrize("seed", [0, 3])
def test_an_obstruction_says_where_its_bodies_part(seed):
    model, scene, rng = random_scene(seed)
    group = model.group("every")
    checker = CollisionModel(model, scene, group.name)
    proof, looked = MotionProof(checker), 0
    while looked < 20:
        q = rng.uniform(group.lower, group.upper)
        obstruction = proof.prove(q[None])
        if obstruction is None or obstruction.away is None:
            continue
        contact = obstruction.contact
        assert contact is not None
        # Where bodies are deep in each other, there is more than one way out.
        if not 1e-4 < contact.depth_m < 3e-3:
            continue
        looked += 1
        farther, nearer = (
            max(
                each.depth_m
                for each in checker.contacts(q + change * obstruction.away)
                if (each.first, each.second) == (contact.first, contact.second)
            )
            for change in (1e-5, -1e-5)
        )
        assert farther < contact.depth_m < nearer


def test_a_deviation_takes_away_from_the_clearance():
    path, clearance = line(-1.0, 0.8), 0.899 - 0.8
    proof = slider(1.0)
    assert proof.prove(path, np.array([[clearance - 0.001]])) is None
    obstruction = proof.prove(path, np.array([[clearance + 0.001]]))
    assert obstruction is not None
    assert obstruction.contact is not None


def test_a_path_of_one_state_is_that_state():
    assert slider(1.0).prove(line(0.0)) is None
    assert slider(1.0).prove(line(0.95)) is not None


def test_the_bounds_follow_a_slider_that_goes_beyond_earlier_paths():
    """A hinge on a slider: the farther it is out, the faster it sweeps."""
    urdf = robot(
        *(link(name) for name in ("base", "turn")),
        link("tip", collision("<sphere radius='0.02'/>")),
        joint("turn", "base", "turn", axis="0 0 1"),
        joint("out", "turn", "tip", kind="prismatic", axis="1 0 0", limits=(0.0, 10.0)),
    )
    pole = CollisionObject("pole", RigidTransform((0.0, 8.0, 0.0)), (PlacedShape(Sphere(0.01)),))
    model = CollisionModel(model_of(urdf), PlanningScene({}, {"pole": pole}))
    proof = MotionProof(model)
    assert proof.prove(np.array([[0.0, 0.1], [3.0, 0.1]])) is None
    assert proof.prove(np.array([[0.0, 8.0], [3.0, 8.0]])) is not None
    assert proof.prove(np.array([[0.0, 7.9], [3.0, 7.9]])) is None


def test_what_always_collides_is_said():
    urdf = robot(
        link("base", collision("<sphere radius='0.1'/>")),
        link("ball", collision("<sphere radius='0.1'/>")),
        joint("x", "base", "ball", kind="prismatic", axis="1 0 0", xyz="1 0 0"),
    )
    box = CollisionObject("box", RigidTransform(), (PlacedShape(Box((0.1, 0.1, 0.1))),))
    proof = MotionProof(CollisionModel(model_of(urdf), PlanningScene({}, {"box": box})))
    obstruction = proof.prove(line(0.0, 0.1))
    assert obstruction is not None
    assert obstruction.reason.startswith("base with box")
    assert not proof.is_free_edge(np.array([0.0]), np.array([0.1]))


def test_a_path_that_cannot_be_proved_ends_after_so_many_states():
    obstruction = between_walls().prove(along(1.2e-5)[1:])
    assert obstruction is not None
    assert obstruction.contact is None
    assert str(obstruction) == "not proved with 20000 states"


def test_contacts_that_find_no_room_are_no_proof(monkeypatch, tmp_path):
    """At 0.5 mm from many balls, all of which are within the first margin."""
    # MuJoCo writes its warning into a file.
    monkeypatch.chdir(tmp_path)
    monkeypatch.setattr(specification, "MEMORY_BYTES", 100_000)
    ball = PlacedShape(Sphere(0.1))
    many = CollisionObject("many", RigidTransform((0.2005, 0.0, 0.0)), (ball,) * 500)
    proof = MotionProof(CollisionModel(model_of(SLIDER), PlanningScene({}, {"many": many})))
    obstruction = proof.prove(line(-0.2, 0.0004))
    assert obstruction is not None
    assert str(obstruction) == "not proved: too many shapes are close to each other"


def test_checks_of_states_after_a_proof_look_for_contacts_only():
    wall = CollisionObject("wall", RigidTransform((1.0, 0.0, 0.0)), (PlacedShape(Sphere(0.1)),))
    model = CollisionModel(model_of(SLIDER), PlanningScene({}, {"wall": wall}))
    MotionProof(model).prove(line(0.0, 2.0))
    assert model.is_free(np.array([0.799]))
    assert not model.contacts(np.array([0.799]))


def test_the_answer_does_not_depend_on_what_was_proved_before():
    first, second = slider(1.0), slider(1.0)
    for place in (0.1, -3.0, 0.5):
        first.prove(line(0.0, place))
    assert first.prove(line(-4.0, 4.0)) == second.prove(line(-4.0, 4.0))
