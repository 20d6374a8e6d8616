"""Problems for planners, made from a seed: three arms, each free, at a shelf, in a box, in clutter.

The arms are the myCobot 280 with its gripper, and made-up ones of six and seven joints, of
capsules. With nothing around and in clutter, they move between random states; at the shelf, from
one compartment to another; from the narrow box, out of it to anywhere. Ends are free, but nobody
knows of a problem whether it has a solution.
"""

from collections.abc import Iterator
from dataclasses import dataclass

import numpy as np

from arm_description import expand_xacro, parse_urdf, resolve_uri
from arm_description.urdf.robot import Box
from arm_node.rigid_transform import RigidTransform
from arm_planning.collision.model import CollisionModel
from arm_planning.errors import PlanningError
from arm_planning.kinematics.inverse import InverseKinematics
from arm_planning.kinematics.search import Orientation
from arm_planning.robot.build import planning_model
from arm_planning.robot.model import PlanningModel
from arm_planning.robot.srdf import parse_srdf
from arm_planning.scene.allowed_collisions import AllowedCollisions
from arm_planning.scene.objects import CollisionObject, PlacedShape
from arm_planning.scene.scene import PlanningScene

MYCOBOT = "package://mycobot_description/urdf/robots/mycobot_280.urdf.xacro"
AXES = {6: "zyyxyx", 7: "zyzyzyz"}
VECTORS = {"x": "1 0 0", "y": "0 1 0", "z": "0 0 1"}
LENGTHS_M = (0.15, 0.2, 0.25, 0.25, 0.15, 0.12, 0.1)
RADIUS_M = 0.045
LIMIT_RAD = 2.8
SCENES = ("free", "shelf", "narrow", "clutter")
SAMPLES = 1000
"""States in which pairs of links are looked at, to find those that always touch."""
GROUP = "arm"
BOXES = 30


@dataclass(frozen=True, slots=True)
class Arm:
    """A robot with one group, and how far it reaches."""

    name: str
    model: PlanningModel
    allowed: AllowedCollisions
    reach_m: float


@dataclass(frozen=True, slots=True)
class Cell:
    """An arm in its surroundings, and the states between which it moves, (n,) each."""

    arm: Arm
    kind: str
    scene: PlanningScene
    problems: tuple[tuple[np.ndarray, np.ndarray], ...]


def arms() -> list[Arm]:
    """Return the three arms."""
    urdf = expand_xacro(resolve_uri(MYCOBOT))
    srdf = '<chain base_link="base_link" tip_link="gripper_base"/>'
    mycobot = _arm("myCobot 280", urdf, srdf, 0.38)
    return [mycobot, *(_made_up(size) for size in AXES)]


def cell(arm: Arm, kind: str, count: int, seed: int = 1) -> Cell:
    """Return an arm's problems in one kind of surroundings."""
    random = np.random.default_rng((seed, SCENES.index(kind), len(arm.model.joints)))
    positions = dict.fromkeys(arm.model.joints, 0.0)
    boxes = dict(_boxes(kind, arm.reach_m, random))
    scene = PlanningScene(positions, objects=boxes, allowed=arm.allowed)
    ends = _Ends(arm, scene, random)
    makers = {"shelf": ends.between_compartments, "narrow": ends.out_of_the_box}
    maker = makers.get(kind, ends.anywhere)
    return Cell(arm, kind, scene, tuple(maker() for _ in range(count)))


class _Ends:
    """Draws free states."""

    def __init__(self, arm: Arm, scene: PlanningScene, random: np.random.Generator) -> None:
        self._checker = CollisionModel(arm.model, scene, GROUP)
        self._group = arm.model.group(GROUP)
        # No time passes for it, so that a busy machine gets the same problems.
        self._inverse = InverseKinematics(arm.model, GROUP, clock=lambda: 0.0)
        self._reach, self._random = arm.reach_m, random

    def anywhere(self) -> tuple[np.ndarray, np.ndarray]:
        return self._state(), self._state()

    def between_compartments(self) -> tuple[np.ndarray, np.ndarray]:
        levels = self._random.permutation(len(SHELF_LEVELS) - 1)[:2]
        start, goal = (self._reaching(*_compartment(level)) for level in levels)
        return start, goal

    def out_of_the_box(self) -> tuple[np.ndarray, np.ndarray]:
        low, high = np.array([0.45, -0.1, 0.15]), np.array([0.65, 0.1, 0.25])
        return self._reaching(low, high), self._state()

    def _draw(self) -> np.ndarray:
        return self._random.uniform(self._group.lower, self._group.upper)

    def _state(self) -> np.ndarray:
        while not self._checker.is_free(q := self._draw()):
            pass
        return q

    def _reaching(self, low: np.ndarray, high: np.ndarray) -> np.ndarray:
        """Return a free state with the tip between two corners, given in reaches."""
        while True:
            target = np.eye(4)
            target[:3, 3] = self._random.uniform(low, high) * self._reach
            try:
                return self._inverse.solve(
                    target,
                    self._draw(),
                    free=self._checker.is_free,
                    random_seed=int(self._random.integers(1 << 30)),
                    orientation=Orientation.ANY,
                )
            except PlanningError:
                continue


SHELF_LEVELS = (0.05, 0.35, 0.65, 0.95)
"""Heights of the shelf's boards, in reaches."""


def _compartment(level: int) -> tuple[np.ndarray, np.ndarray]:
    low, high = SHELF_LEVELS[level] + 0.08, SHELF_LEVELS[level + 1] - 0.08
    return np.array([0.55, -0.2, low]), np.array([0.75, 0.2, high])


def _boxes(
    kind: str, reach_m: float, random: np.random.Generator
) -> Iterator[tuple[str, CollisionObject]]:
    """Yield the boxes of a scene; their sizes and places are in reaches."""
    if kind == "shelf":
        for number, height in enumerate(SHELF_LEVELS):
            yield _box(f"board{number}", (0.3, 0.7, 0.03), (0.7, 0.0, height), reach_m)
        for name, y in (("left", 0.36), ("right", -0.36)):
            yield _box(name, (0.3, 0.03, 0.95), (0.7, y, 0.5), reach_m)
        yield _box("back", (0.03, 0.7, 0.95), (0.86, 0.0, 0.5), reach_m)
    if kind == "narrow":
        for name, y in (("left", 0.24), ("right", -0.24)):
            yield _box(name, (0.53, 0.03, 0.25), (0.55, y, 0.125), reach_m)
        for name, x in (("near", 0.3), ("far", 0.8)):
            yield _box(name, (0.03, 0.48, 0.25), (x, 0.0, 0.125), reach_m)
        yield _box("floor", (0.53, 0.48, 0.03), (0.55, 0.0, -0.02), reach_m)
    if kind == "clutter":
        for number in range(BOXES):
            place = random.uniform((-1.0, -1.0, 0.0), (1.0, 1.0, 1.0))
            while np.hypot(place[0], place[1]) < 0.35:
                place = random.uniform((-1.0, -1.0, 0.0), (1.0, 1.0, 1.0))
            size = random.uniform(0.05, 0.18, 3)
            yield _box(f"box{number}", tuple(size), tuple(place), reach_m)


def _box(
    name: str, size: tuple[float, ...], place: tuple[float, ...], reach_m: float
) -> tuple[str, CollisionObject]:
    x, y, z = (reach_m * float(side) for side in size)
    u, v, w = (reach_m * float(at) for at in place)
    shape = PlacedShape(Box((x, y, z)))
    return name, CollisionObject(name, RigidTransform((u, v, w)), (shape,))


def _made_up(size: int) -> Arm:
    parts = []
    for n in range(size + 1):
        length = LENGTHS_M[n] if n < len(LENGTHS_M) else 0.1
        parts.append(
            f"<link name='l{n}'><collision><origin xyz='0 0 {length / 2}'/><geometry>"
            f"<capsule radius='{RADIUS_M}' length='{max(length - RADIUS_M, 0.01)}'/>"
            "</geometry></collision></link>"
        )
    for n, axis in enumerate(AXES[size]):
        parts.append(
            f"<joint name='j{n}' type='revolute'><parent link='l{n}'/><child link='l{n + 1}'/>"
            f"<origin xyz='0 0 {LENGTHS_M[n]}'/><axis xyz='{VECTORS[axis]}'/>"
            f"<limit lower='{-LIMIT_RAD}' upper='{LIMIT_RAD}' effort='1' velocity='2'/></joint>"
        )
    urdf = f"<robot name='arm{size}'>{''.join(parts)}</robot>"
    return _arm(f"{size} joints", urdf, f"<chain base_link='l0' tip_link='l{size}'/>", 1.0)


def _arm(name: str, urdf: str, group: str, reach_m: float) -> Arm:
    robot = parse_urdf(urdf)
    text = f"<robot name='{robot.name}'><group name='{GROUP}'>{group}</group></robot>"
    model = planning_model(robot, parse_srdf(text, robot), warn=lambda _: None)
    adjacent = {tuple(sorted((joint.parent, joint.child))): True for joint in robot.joints}
    # What touches in nearly every state belongs together, as in a setup assistant's SRDF.
    random = np.random.default_rng(0)
    scene = PlanningScene(
        dict.fromkeys(model.joints, 0.0), allowed=AllowedCollisions(pairs=adjacent)
    )
    checker = CollisionModel(model, scene, GROUP)
    seen: dict[tuple[str, str], int] = {}
    group = model.group(GROUP)
    samples = random.uniform(group.lower, group.upper, (SAMPLES, len(group.joints)))
    for q in samples:
        for contact in checker.contacts(q):
            pair = tuple(sorted((contact.first, contact.second)))
            seen[pair] = seen.get(pair, 0) + 1
    always = {pair: True for pair, times in seen.items() if times > 0.8 * len(samples)}
    return Arm(name, model, AllowedCollisions(pairs=adjacent | always), reach_m)
