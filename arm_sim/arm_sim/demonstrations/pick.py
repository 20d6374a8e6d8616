"""Demonstrates picks: each seed is one scene, in which the expert lifts the cylinder, or fails."""

import time
from collections.abc import Sequence
from dataclasses import asdict, dataclass
from functools import partial
from typing import Any

import numpy as np
from numpy.typing import NDArray

from arm_controller.pick_plan import PlanError
from arm_gazebo.camera.film import FilmCrew
from arm_planning.errors import PlanningError
from arm_sim.dataset import CameraStream, Samples, Stream
from arm_sim.demonstrations.pick_scene import (
    CAMERAS,
    WORLD,
    PickScene,
    PickStage,
    draw_scene,
)
from arm_sim.gym.arm_env import DECISION_S, ArmEnv
from arm_sim.gym.pick import OBJECT, ArmPick

WIDTH, HEIGHT = 320, 240
FRAMES = 200
TASK = "Lift the red cylinder."
ROBOT = "mycobot_280"
SURROUNDINGS = ("object.x", "object.y", "object.z", "lift")


@dataclass(frozen=True, slots=True)
class Demonstration:
    """One episode of the expert.

    Attributes:
        seed: its seed.
        failure: why it shows no success; "" for a success. A plan that failed has no rows.
        scene: what was drawn for it.
        joints: names of the joints.
        states: positions of the joints before each action, shape (m, n).
        surroundings: the cylinder's position, and the height to lift it to, shape (m, 4).
        commands: positions that the joints are commanded to, shape (m, n).
        images: by camera, shape (m, height, width, 3).
        processor_s: processor time that it took.
    """

    seed: int
    failure: str
    scene: dict[str, Any]
    joints: tuple[str, ...]
    states: NDArray[np.float32]
    surroundings: NDArray[np.float32]
    commands: NDArray[np.float32]
    images: dict[str, NDArray[np.uint8]]
    processor_s: float

    def streams(self) -> list[Stream]:
        """Return its rows as streams of a dataset; the first one defines the rows."""
        stamps = np.arange(len(self.states), dtype=np.int64) * round(DECISION_S * 1e9)
        cameras: list[Stream] = [
            CameraStream(f"observation.images.{name}", stamps, HEIGHT, WIDTH, partial(iter, frames))
            for name, frames in self.images.items()
        ]
        labels = tuple(f"{name}.pos" for name in self.joints)
        targets = tuple(f"{name}.cmd" for name in self.joints)
        return [
            *cameras,
            Samples("observation.state", stamps, self.states, labels),
            Samples("observation.environment_state", stamps, self.surroundings, SURROUNDINGS),
            Samples("action", stamps, self.commands, targets),
        ]


class PickDemonstrator:
    """Makes demonstrations one after the other; equal seeds give equal bits.

    Args:
        frames: rows of a demonstration, `DECISION_S` apart.
        cameras: which of `CAMERAS` film it.
        backend: see `FilmCrew`.
    """

    def __init__(
        self, frames: int = FRAMES, cameras: Sequence[str] = CAMERAS, backend: str = "auto"
    ) -> None:
        self._frames = frames
        self._stage: PickStage | None = None
        self._env = ArmPick(expert=True, vary=self._vary, simulation={"world": WORLD})
        physics = self._env.simulation.parts.physics
        self._crew = FilmCrew(physics, cameras, WIDTH, HEIGHT, backend)

    def make(self, seed: int) -> Demonstration:
        """Return the demonstration of a seed.

        Raises:
            CameraError: the pictures cannot be drawn.
        """
        began_s = time.process_time()
        try:
            _, info = self._env.reset(seed=seed)
        except (PlanError, PlanningError) as error:
            return self._result(seed, f"no plan: {error}", [], began_s)
        self._crew.show(self._scene.look)
        rows: list[tuple[Any, ...]] = []
        for _ in range(self._frames):
            env = self._env
            place = np.append(env.point(OBJECT), env.goal["lift"])
            before = env.position, place, self._crew.images()
            _, _, _, _, info = env.step(info["expert_action"])
            rows.append((*before, env.command))
        failure = "" if info["is_success"] else "the cylinder is not up at the end"
        return self._result(seed, failure, rows, began_s)

    def close(self) -> None:
        """End the simulation and the renderer."""
        self._crew.close()
        self._env.close()

    def _vary(self, env: ArmEnv, random: np.random.Generator) -> None:
        self._stage = self._stage or PickStage(env)
        self._scene: PickScene = draw_scene(random, len(env.joints))
        self._stage.set_up(self._scene)

    def _result(
        self, seed: int, failure: str, rows: list[tuple[Any, ...]], began_s: float
    ) -> Demonstration:
        states, places, images, commands = zip(*rows, strict=True) if rows else ((), (), (), ())
        return Demonstration(
            seed,
            failure,
            asdict(self._scene),
            self._env.joints,
            np.array(states, dtype=np.float32),
            np.array(places, dtype=np.float32),
            np.array(commands, dtype=np.float32),
            {name: np.stack([one[name] for one in images]) for name in (images or [{}])[0]},
            time.process_time() - began_s,
        )
