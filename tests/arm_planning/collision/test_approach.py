from itertools import product

import mujoco
import numpy as np
import pytest
from planning_models import model_of, neighbours
from robots import joint, link, robot

from arm_node.rigid_transform import RigidTransform
from arm_planning.collision.approach import Approach
from arm_planning.collision.model import CollisionModel
from arm_planning.collision.reach import reach
from arm_planning.scene.objects import CollisionObject, PlacedShape
from arm_planning.scene.scene import PlanningScene
from arm_planning.scene.shapes import Sphere

JOINTS = ("j1", "j2", "j3", "j4")
ERROR_M = 1e-5
"""More than the error of MuJoCo's distances, which are small where they are asked for."""
FAR_M = 10.0


def arm_at_balls(slider: int, shape: str) -> CollisionModel:
    """An arm of four links, of which one slides, with balls around it."""
    links = [link("l0")]
    joints = []
    place = f"<collision><origin xyz='0.05 0 0.1'/><geometry>{shape}</geometry></collision>"
    for number, axis in enumerate(("0 0 1", "0 1 0", "0.6 0 0.8", "1 0 0"), 1):
        links.append(link(f"l{number}", place))
        kind, span = ("prismatic", (-0.3, 0.3)) if number == slider else ("revolute", (-3.0, 3.0))
        names = (f"j{number}", f"l{number - 1}", f"l{number}")
        joints.append(joint(*names, kind=kind, axis=axis, limits=span, xyz="0.03 0 0.2"))
    model = model_of(robot(*links, *joints), arm=(JOINTS, "l4"))
    balls = {
        f"b{n}": CollisionObject(f"b{n}", RigidTransform(place), (PlacedShape(Sphere(0.02)),))
        for n, place in enumerate([(0.5, 0.0, 0.3), (-0.4, 0.3, 0.6), (0.1, -0.5, 0.9)])
    }
    scene = PlanningScene(dict.fromkeys(JOINTS, 0.0), objects=balls, allowed=neighbours(model))
    return CollisionModel(model, scene, "arm")


class Arm:
    """The arm, its pairs of geoms, and how soon they can meet."""

    def __init__(self, slider: int, shape: str) -> None:
        checker = arm_at_balls(slider, shape)
        self.posed, self.model, self.data = checker.posed, checker.posed.model, checker.posed.data
        self.lower, self.upper = np.array([checker.limits(name) for name in checker.joints]).T
        self.bounds = reach(self.model, self.data, self.lower, self.upper)
        self.approach = Approach(self.model, self.data, self.bounds)
        part = self.bounds.part
        self.last = int(part.argmax())
        self.pairs = [
            (first, second)
            for first, second in product(range(self.model.ngeom), repeat=2)
            if part[first] != part[second]
        ]

    def distance(self, q: np.ndarray, geoms: tuple[int, int]) -> float:
        self.posed.place(q)
        return mujoco.mj_geomDistance(self.model, self.data, *geoms, FAR_M, None)

    def chord(self, rng: np.random.Generator) -> tuple[np.ndarray, np.ndarray, float]:
        """A start, a change, and where on it to begin."""
        start, end = rng.uniform(self.lower, self.upper, (2, len(self.lower)))
        return start, end - start, rng.uniform()

    def slow_chord(self, rng: np.random.Generator) -> tuple[np.ndarray, np.ndarray, float]:
        """A chord in whose middle the middle of the last link stands still."""
        middle = rng.uniform(self.lower, self.upper) / 2.0
        jacobian = []
        for step in np.eye(len(middle)) * 1e-6:
            self.posed.place(middle + step)
            there = self.data.geom_xpos[self.last].copy()
            self.posed.place(middle - step)
            jacobian.append((there - self.data.geom_xpos[self.last]) / 2e-6)
        change = 2.0 * np.linalg.svd(np.array(jacobian).T)[2][-1]
        return middle - change / 2.0, change, 0.5

    def clear(self, change: np.ndarray, geoms: tuple[int, int], lost: float) -> tuple[float, float]:
        """Return what speeds prove, and what reach does, in the state that is set."""
        first, second = self.bounds.part[list(geoms)].tolist()
        pair = first * len(self.bounds.pairs) + second
        rate = self.bounds.pairs[first, second] @ np.abs(change)
        by_reach = lost / rate
        return self.approach.clear([(by_reach, lost, pair, *geoms)], np.inf), by_reach


LONG, SMALL = "<box size='0.1 0.04 0.3'/>", "<sphere radius='0.005'/>"


@pytest.mark.parametrize("is_slow", [False, True])
@pytest.mark.parametrize("shape", [LONG, SMALL])
@pytest.mark.parametrize("slider", [0, 1, 2, 3])
def test_a_distance_is_not_lost_in_the_part_of_a_chord_that_keeps_it(slider, shape, is_slow):
    arm, rng = Arm(slider, shape), np.random.default_rng(slider)
    gains = []
    for _ in range(30):
        start, change, at = arm.slow_chord(rng) if is_slow else arm.chord(rng)
        arm.approach.begin(change)
        for geoms in arm.pairs:
            before = arm.distance(start + at * change, geoms)
            if before <= 0.0:
                continue
            lost = before * 10.0 ** rng.uniform(-3.0, -0.3)
            clear, by_reach = arm.clear(change, geoms, lost)
            gains.append(clear / by_reach)
            for fraction in np.linspace(max(at - clear, 0.0), min(at + clear, 1.0), 5):
                there = arm.distance(start + fraction * change, geoms)
                assert there >= before - lost - ERROR_M, (geoms, at, fraction)
    assert np.mean(gains) > 1.2
