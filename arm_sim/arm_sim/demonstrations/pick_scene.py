"""What differs from pick to pick: the start, the cylinder, the things around it, light, cameras."""

import math
from dataclasses import dataclass

import numpy as np

from arm_gazebo.camera.film import Look
from arm_sim.gym.arm_env import ArmEnv
from arm_sim.gym.pick import OBJECT, STANDING_M

WORLD = "pick_demonstrations"
CAMERAS = ("front", "side")
DISTRACTORS = tuple(f"distractor_{number}" for number in range(1, 6))

NEAREST_M, FARTHEST_M, MOST_ASIDE = 0.2, 0.255, 1.0
"""Where the cylinder stands: distance from the arm's axis, and direction from ahead in rad."""
LIGHTEST_KG, HEAVIEST_KG = 0.03, 0.08
START_RAD = 0.4
"""How far each joint may be from 0 at the start."""
MOST_OPEN, MOST_CLOSED = 0.15, -0.3
START_S = 1.0
CLEAR_M = 0.13
"""Least distance of a distractor from the cylinder, the arm's axis and other distractors."""
OUTER_M = 0.45
TRIES = 100
CAMERA_M, CAMERA_RAD = 0.05, 0.06
DARKEST, BRIGHTEST, TINT, SUN_TURN = 0.5, 1.2, 0.1, 0.5


@dataclass(frozen=True, slots=True)
class PickScene:
    """One scene; lengths in m, angles in rad.

    Attributes:
        start: positions of the joints at the start, shape (n,).
        place: x and y of the cylinder.
        mass_kg: its mass.
        distractors: x, y and turn of the things around it, by name.
        look: colours, light and cameras.
    """

    start: tuple[float, ...]
    place: tuple[float, float]
    mass_kg: float
    distractors: dict[str, tuple[float, float, float]]
    look: Look


def draw_scene(random: np.random.Generator, joints: int) -> PickScene:
    """Return a random scene for an arm of some joints, the last of which is the gripper."""
    start = random.uniform(-START_RAD, START_RAD, joints)
    start[-1] = random.uniform(MOST_CLOSED, MOST_OPEN)
    distance, aside = random.uniform(NEAREST_M, FARTHEST_M), random.uniform(-MOST_ASIDE, MOST_ASIDE)
    place = (distance * math.cos(aside), distance * math.sin(aside))
    mass_kg = random.uniform(LIGHTEST_KG, HEAVIEST_KG)
    distractors = _draw_distractors(random, place)
    return PickScene(
        tuple(start.tolist()), place, mass_kg, distractors, _draw_look(random, list(distractors))
    )


def _draw_look(random: np.random.Generator, coloured: list[str]) -> Look:
    light = random.uniform(DARKEST, BRIGHTEST) * random.uniform(1.0 - TINT, 1.0 + TINT, 3)
    reach = np.repeat((CAMERA_M, CAMERA_RAD), 3)
    return Look(
        {name: tuple(random.uniform(0.0, 1.0, 3).tolist()) for name in coloured},
        tuple(light.tolist()),
        tuple(random.uniform(-SUN_TURN, SUN_TURN, 3).tolist()),
        {name: tuple(random.uniform(-reach, reach).tolist()) for name in CAMERAS},
    )


def _draw_distractors(
    random: np.random.Generator, place: tuple[float, float]
) -> dict[str, tuple[float, float, float]]:
    taken, found = [(0.0, 0.0), place], dict[str, tuple[float, float, float]]()
    names = random.permutation(DISTRACTORS)[: random.integers(len(DISTRACTORS) + 1)]
    for name in names.tolist():
        for _ in range(TRIES):
            x, y = random.uniform(-OUTER_M, OUTER_M, 2).tolist()
            if all(math.hypot(x - a, y - b) >= CLEAR_M for a, b in taken):
                taken.append((x, y))
                found[name] = (x, y, random.uniform(-math.pi, math.pi))
                break
    return found


class PickStage:
    """Sets scenes up in an environment of the pick, in the world `WORLD`."""

    def __init__(self, env: ArmEnv) -> None:
        self._env = env
        model = env.simulation.parts.physics.model
        self._heights = {name: model.body(name).pos[2] for name in DISTRACTORS}

    def set_up(self, scene: PickScene) -> None:
        """Bring everything to its place and the arm to its start, right after a reset."""
        simulation = self._env.simulation
        simulation.set_properties(OBJECT, mass_kg=scene.mass_kg)
        simulation.place(OBJECT, (*scene.place, STANDING_M))
        for name, (x, y, turn) in scene.distractors.items():
            simulation.place(name, (x, y, self._heights[name], 0.0, 0.0, turn))
        self._env.move(np.array(scene.start), START_S)
